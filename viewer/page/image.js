// Pictures on a canvas, by WebGL2: the weighted sum of the layers of one picture, beside or minus those of another.

export const MAX_LAYERS = 16;

const VERTEX = `#version 300 es
uniform vec4 place;  // of the picture on the canvas: scale and offset in clip space
out vec2 film;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  film = vec2(corner.x, 1.0 - corner.y);
  gl_Position = vec4(corner * place.xy + place.zw, 0.0, 1.0);
}`;

const FRAGMENT = `#version 300 es
precision highp float;
precision highp sampler2DArray;
uniform sampler2DArray first, second;
uniform float first_weights[${MAX_LAYERS}], second_weights[${MAX_LAYERS}];
uniform int first_count, second_count, mode;  // 0 colour, 1 false colour, 2 difference
uniform float exposure, split;
in vec2 film;
out vec4 colour;

vec3 sum_of(sampler2DArray layers, float weights[${MAX_LAYERS}], int count) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < count; ++i)
    if (weights[i] != 0.0) sum += weights[i] * texture(layers, vec3(film, float(i))).rgb;
  return sum;
}
vec3 to_srgb(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}
// Five colours of viridis, from -8 to +2 stops around white.
vec3 false_colour(float value) {
  float t = clamp((log2(max(value, 1e-30)) + 8.0) / 10.0, 0.0, 1.0) * 4.0;
  vec3 c[5] = vec3[5](vec3(0.267, 0.005, 0.329), vec3(0.230, 0.322, 0.546), vec3(0.128, 0.567, 0.551),
                      vec3(0.369, 0.789, 0.383), vec3(0.993, 0.906, 0.144));
  int i = min(int(t), 3);
  return mix(c[i], c[i + 1], t - float(i));
}
vec3 signed_colour(float d) {
  vec3 end = d > 0.0 ? vec3(0.75, 0.02, 0.05) : vec3(0.03, 0.2, 0.75);
  return mix(vec3(1.0), end, clamp(abs(d), 0.0, 1.0));
}
void main() {
  float gain = exp2(exposure);
  bool right = split >= 0.0 && film.x > split;
  vec3 value = mode == 2 || !right ? sum_of(first, first_weights, first_count)
                                   : sum_of(second, second_weights, second_count);
  if (mode == 2) {
    vec3 d = value - sum_of(second, second_weights, second_count);
    colour = vec4(signed_colour(gain * dot(d, vec3(1.0 / 3.0))), 1.0);
  } else if (any(isnan(value))) {
    colour = vec4(1.0, 0.0, 1.0, 1.0);
  } else if (mode == 1) {
    colour = vec4(false_colour(gain * dot(value, vec3(0.2126, 0.7152, 0.0722))), 1.0);
  } else {
    colour = vec4(to_srgb(gain * value), 1.0);
  }
}`;

const halfTable = (() => {
  const table = new Float32Array(65536);
  for (let h = 0; h < 65536; ++h) {
    const exponent = (h >> 10) & 31, mantissa = h & 1023, sign = h & 0x8000 ? -1 : 1;
    table[h] = exponent === 0 ? sign * mantissa * 2 ** -24
      : exponent === 31 ? (mantissa ? NaN : sign * Infinity) : sign * (1 + mantissa / 1024) * 2 ** (exponent - 15);
  }
  return table;
})();

/** A frame of the server: size, layers, and their float16 values. */
export class Picture {
  constructor(header, halves) {
    Object.assign(this, header);
    this.layers = header.layers.slice(0, MAX_LAYERS);
    this.halves = halves;
  }
  /** R, G and B of a layer at a pixel. */
  value(layer, x, y) {
    const at = 3 * ((layer * this.height + y) * this.width + x);
    return [0, 1, 2].map((c) => this.scale * halfTable[this.halves[at + c]]);
  }
  /** The sum that is shown at a pixel. */
  sum(weights, x, y) {
    const total = [0, 0, 0];
    weights.forEach((w, layer) => {
      if (w !== 0) this.value(layer, x, y).forEach((v, c) => { total[c] += w * v; });
    });
    return total;
  }
}

export class ImageCanvas {
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { preserveDrawingBuffer: true, antialias: false });
    if (!gl) throw new Error("This browser offers no WebGL2, which shows the images.");
    this.canvas = canvas, this.gl = gl, this.textures = new Map();
    const program = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    gl.useProgram(program);
    this.uniform = (name) => gl.getUniformLocation(program, name);
    gl.bindVertexArray(gl.createVertexArray());
  }

  upload(name, picture) {
    const gl = this.gl;
    this.remove(name);
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 2);
    gl.texImage3D(gl.TEXTURE_2D_ARRAY, 0, gl.RGB16F, picture.width, picture.height, picture.layers.length, 0, gl.RGB,
                  gl.HALF_FLOAT, picture.halves, 0);
    for (const [key, value] of [[gl.TEXTURE_MIN_FILTER, gl.LINEAR], [gl.TEXTURE_MAG_FILTER, gl.NEAREST],
                                [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]])
      gl.texParameteri(gl.TEXTURE_2D_ARRAY, key, value);
    this.textures.set(name, texture);
  }
  remove(name) {
    if (this.textures.has(name)) this.gl.deleteTexture(this.textures.get(name));
    this.textures.delete(name);
  }

  /** first, second: {name, picture, weights}; second may be null. place: {x, y, width, height} of the picture in
   * canvas pixels, y downwards. */
  draw(first, second, place, { mode, exposure, split }) {
    const gl = this.gl, { width, height } = this.canvas;
    gl.viewport(0, 0, width, height);
    gl.clearColor(0.1, 0.1, 0.1, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    if (!first) return;
    const bind = (unit, name, shown) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D_ARRAY, this.textures.get(shown.name));
      gl.uniform1i(this.uniform(name), unit);
      const weights = new Float32Array(MAX_LAYERS);
      shown.weights.forEach((w, i) => { weights[i] = w * shown.picture.scale; });
      gl.uniform1fv(this.uniform(`${name}_weights`), weights);
      gl.uniform1i(this.uniform(`${name}_count`), shown.picture.layers.length);
    };
    bind(0, "first", first);
    bind(1, "second", second || first);
    gl.uniform1i(this.uniform("mode"), mode === 2 && !second ? 0 : mode);
    gl.uniform1f(this.uniform("exposure"), exposure);
    gl.uniform1f(this.uniform("split"), second && split !== null ? split : -1);
    gl.uniform4f(this.uniform("place"), 2 * place.width / width, 2 * place.height / height, 2 * place.x / width - 1,
                 1 - 2 * (place.y + place.height) / height);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }
}

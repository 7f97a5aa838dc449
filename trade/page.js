// The flip book of trade.html: pictures of `book` (page.cpp), flipped, zoomed and held against the reference.
"use strict";
const canvas = document.getElementById("view"), beside = document.getElementById("difference");
const slider = document.getElementById("exposure"), gain = document.getElementById("gain");
const caption = document.getElementById("caption"), buttons = document.getElementById("buttons");
const view = canvas.getContext("2d"), differences = beside.getContext("2d");
let current = 0, zoom = 1, difference = true;

// Upper half: mantissas; lower half: exponents.
function decode(image, width, height) {
    const work = document.createElement("canvas");
    work.width = width; work.height = 2 * height;
    const context = work.getContext("2d", { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    const bytes = context.getImageData(0, 0, width, 2 * height).data, n = width * height;
    const values = new Float32Array(3 * n);
    for (let p = 0; p < n; ++p) {
        const exponent = bytes[4 * (n + p)];
        if (exponent === 0) continue;
        const scale = Math.pow(2, exponent - 136);
        for (let c = 0; c < 3; ++c) values[3 * p + c] = (bytes[4 * p + c] + 0.5) * scale;
    }
    return values;
}

function srgb(v) {
    return v <= 0.0031308 ? 12.92 * v : 1.055 * Math.pow(v, 1 / 2.4) - 0.055;
}

function luminance(values, p) {
    return 0.2126 * values[3 * p] + 0.7152 * values[3 * p + 1] + 0.0722 * values[3 * p + 2];
}

function draw() {
    const picture = book.pictures[current], reference = book.pictures[0].values, values = picture.values;
    if (!values || !reference) return;
    const stops = Number(slider.value), scale = Math.pow(2, stops), factor = Math.pow(2, Number(gain.value));
    const out = view.createImageData(book.width, book.height);
    const amplified = differences.createImageData(book.width, book.height);
    for (let p = 0; p < book.width * book.height; ++p) {
        for (let c = 0; c < 3; ++c)
            out.data[4 * p + c] = 255 * srgb(Math.min(1, values[3 * p + c] * scale)) + 0.5;
        const d = factor * scale * (luminance(values, p) - luminance(reference, p));
        const shade = srgb(Math.min(1, Math.abs(d)));
        amplified.data[4 * p] = d > 0 ? 255 * shade : 0;
        amplified.data[4 * p + 1] = 90 * shade;
        amplified.data[4 * p + 2] = d > 0 ? 0 : 255 * shade;
        out.data[4 * p + 3] = amplified.data[4 * p + 3] = 255;
    }
    view.putImageData(out, 0, 0);
    differences.putImageData(amplified, 0, 0);
    for (const c of [canvas, beside]) c.style.width = book.width * zoom + "px";
    beside.style.display = difference ? "block" : "none";
    caption.textContent = picture.name + (picture.note ? ": " + picture.note : "") +
        (difference ? ". Beside it the difference to the reference, times " + factor +
                      ": red too bright, blue too dark" : "");
    document.getElementById("stops").textContent = (stops > 0 ? "+" : "") + stops.toFixed(2) + " stops";
    document.getElementById("factor").textContent = factor;
    for (let i = 0; i < buttons.children.length; ++i)
        buttons.children[i].className = i === current ? "on" : "";
    document.getElementById("beside").className = difference ? "on" : "";
}

function flip(index) {
    const n = book.pictures.length;
    current = (index + n) % n;
    draw();
}

function toggle() {
    difference = !difference;
    draw();
}

function zoomBy(step) {
    zoom = Math.min(32, Math.max(1, step > 0 ? zoom * 2 : Math.floor(zoom / 2)));
    draw();
}

book.pictures.forEach((picture, i) => {
    const button = document.createElement("button");
    button.textContent = (i < 9 ? (i + 1) + "  " : "") + picture.name;
    button.onclick = () => flip(i);
    buttons.appendChild(button);
    const image = new Image();
    image.onload = () => { picture.values = decode(image, book.width, book.height); draw(); };
    image.src = picture.source;
});
for (const c of [canvas, beside]) { c.width = book.width; c.height = book.height; }
zoom = Math.max(1, Math.floor(640 / book.width));
slider.value = book.exposure;
slider.oninput = draw;
gain.oninput = draw;
document.getElementById("beside").onclick = toggle;
document.getElementById("closer").onclick = () => zoomBy(1);
document.getElementById("farther").onclick = () => zoomBy(-1);
document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const number = Number(event.key);
    if (number >= 1 && number <= Math.min(9, book.pictures.length)) flip(number - 1);
    else if (event.key === "d") toggle();
    else if (event.key === "+") zoomBy(1);
    else if (event.key === "-") zoomBy(-1);
    else if (event.target === slider || event.target === gain) return;
    else if (event.key === "ArrowRight") flip(current + 1);
    else if (event.key === "ArrowLeft") flip(current - 1);
});

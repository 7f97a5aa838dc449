"""Settings of a figure's scenes by its command line: `--bound 5`, `--film.width 80`, without editing the script.

A name with a dot is a path, as with `mote render -D`. Others are $parameters of the scene file where it has one of that
name, else parameters of the integrator, for the renders whose integrator takes them: `--bound 5` reaches mote_vpl and not
the path tracer beside it. What no render took is an error.
"""
import re
import subprocess


class OwnSettings:
    def __init__(self, words, program):
        """`words`: what argparse left, --NAME VALUE, --NAME=VALUE or --NAME alone, which is true."""
        self.values, self.taken, self.program, self.pages = {}, set(), program, None
        name = None
        for word in words:
            if word.startswith("--"):
                name, equals, value = word[2:].partition("=")
                self.values[name] = value if equals else "true"
            elif name is not None and self.values[name] == "true":
                self.values[name] = word
            else:
                raise ValueError(f"'{word}' belongs to no --NAME")

    def __bool__(self):
        return bool(self.values)

    def suffix(self):
        """Suffix of file names: images with settings of their own are other images."""
        return "".join(f"_{name}={value}" for name, value in self.values.items()).replace("/", "-")

    def added_to(self, scene, settings):
        """The settings of a render, with those of the command line that it takes."""
        own = {}
        for name, value in self.values.items():
            place = self.place(name, scene.read_text(encoding="utf-8"), settings)
            if place:
                own[place] = value
                self.taken.add(name)
        return {**settings, **own}

    def place(self, name, text, settings):
        if "." in name:
            return name
        if re.search(rf"\${name}\b", text):
            return name
        named = re.search(r'<integrator\s+type="([^"$]+)"', text)
        integrator = settings.get("integrator", named.group(1) if named else "mote_layers")
        return f"integrator.{name}" if name in self.parameters(integrator) else None

    def parameters(self, integrator):
        """Names of an integrator's parameters, from its manual page."""
        return re.findall(r"^\| `(\w+)` \|", self.manual().get(integrator, ""), re.M)

    def manual(self):
        """Pages of all integrators."""
        if self.pages is None:
            formats = subprocess.run([self.program, "formats"], check=True, capture_output=True, text=True).stdout
            self.pages = dict(re.findall(r"^### `(mote_\w+|path|volpath)`$(.*?)(?=^##)", formats, re.M | re.S))
        return self.pages

    def check_names(self, files):
        """Raises ValueError, before the first render, for names that are in none of the files as $NAME and that no integrator has."""
        if not self.values:
            return
        text = "".join(file.read_text(encoding="utf-8") for file in files)
        known = {name for page in self.manual() for name in self.parameters(page)}
        unknown = [f"--{name}" for name in self.values
                   if "." not in name and name not in known and not re.search(rf"\${re.escape(name)}\b", text)]
        if unknown:
            raise ValueError(f"there is no {', '.join(unknown)}: neither a $parameter of a scene nor one of an integrator")

    def check(self):
        """Raises ValueError for settings that were not taken."""
        left = [f"--{name}" for name in self.values if name not in self.taken]
        if left:
            raise ValueError(f"no render takes {', '.join(left)}: neither a $parameter of a scene nor one of an integrator")

#!/usr/bin/env python3
"""Translates fragment shaders to C++ that shades several pixels at once.

Writes shader_uniforms.h, plain structs of the uniforms, shaders.h, structs whose main() is that of a shader, and
shader_streams.h: of the shaders that read and write arrays, with an element for each lane, their arrays.
Types, functions and samplers are those of src/easypbr/native/simd. Macros are what #ifdef sees; features
(#feature) become members of the uniforms. What changes:

- float, bool, uint: vfloat, vbool, vuint. int, and bool variables: auto, the same for all pixels where their
  value is.
- uniforms: plain values, which convert to lanes.
- c ? a : b: select(c, a, b). An if whose condition differs between pixels does not compile: the shader has to
  use ?: there, any_lane() for the conditions of loops.
- if (c) discard: the pixels for which c holds are written no more.
- swizzles: member functions. Literals: floats.
- outputs: members, and outputs() lists them by location as four channels each.
"""

import argparse
import re
import sys
from pathlib import Path

TOKEN = re.compile(
    r"(?P<number>(?:\d+\.\d*|\.\d+|\d+(?=[eE]))(?:[eE][+-]?\d+)?|0x[0-9a-fA-F]+u?|\d+u?)"
    r"|(?P<name>[A-Za-z_]\w*)|(?P<op>\+\+|--|<<=|>>=|<<|>>|[-+*/&|^=!<>]=|&&|\|\||[-+*/%&|^~!<>=?:;,.(){}\[\]])"
)
ASSIGNMENTS = {"=", "+=", "-=", "*=", "/=", "&=", "|=", "^=", "<<=", ">>="}
CLOSING = {"(": ")", "[": "]", "{": "}"}
COMPONENTS = {"r": "x", "g": "y", "b": "z", "a": "w"}
TYPES = {"float": "vfloat", "uint": "vuint", "bool": "vbool"}
NATIVE_FUNCTIONS = ("any_lane(", "layer_bounds(")  # macros for the driver
INTERPOLATIONS = {"flat", "smooth", "noperspective"}
UNIFORM_TYPES = {"float": "float", "int": "int", "bool": "bool", "mat3": "mat3",
                 "vec2": "uni::vec2", "vec3": "uni::vec3", "vec4": "uni::vec4"}  # fmt: skip


class ShaderError(Exception):
    """The text is beyond what is translated."""


class Text:
    """A shader's text with its includes, after the preprocessor."""

    def __init__(self, folder: Path, macros: dict[str, str], without: list[str]) -> None:
        self.folder, self.macros, self.without = folder, macros, without
        self.features: list[tuple[str, str]] = []  # macro, constant
        self.files: list[str] = []

    def read(self, name: str) -> str:
        if name in self.files:
            return ""
        self.files.append(name)
        lines = []
        taken = [True]  # of each open #if
        for line in re.sub(r"//.*", "", (self.folder / name).read_text()).splitlines():
            words = line.split()
            directive = words[0] if words and words[0].startswith("#") else ""
            if directive in ("#ifdef", "#ifndef"):
                taken.append(taken[-1] and (words[1] in self.macros) == (directive == "#ifdef"))
            elif directive == "#else":
                taken[-1] = taken[-2] and not taken[-1]
            elif directive == "#endif":
                taken.pop()
            elif not taken[-1]:
                continue
            elif directive == "#include":
                lines.append(self.read(words[1].strip('"')))
            elif directive == "#feature":
                self.features.append((words[1], words[2]))
            elif directive == "#define" and words[1].startswith(NATIVE_FUNCTIONS):
                continue
            elif directive:
                raise ShaderError(f"{name}: {line}")
            else:
                lines.append(line)
        text = "\n".join(lines)
        for macro, value in self.macros.items():
            if value:
                text = re.sub(rf"\b{macro}\b", value, text)
        return text


def tokens_of(text: str) -> list[str]:
    tokens, at = [], 0
    while at < len(text):
        if text[at].isspace():
            at += 1
            continue
        match = TOKEN.match(text, at)
        if not match:
            raise ShaderError(f"unexpected {text[at:at + 20]!r}")
        tokens.append(match.group())
        at = match.end()
    return tokens


def tree_of(tokens: list[str]) -> list:
    """Tokens, with a list [opening, content, closing] for each pair of brackets."""
    stack: list[list] = [[]]
    for token in tokens:
        if token in CLOSING:
            stack.append([])
        elif token in CLOSING.values():
            content = stack.pop()
            opening = next(o for o, c in CLOSING.items() if c == token)
            stack[-1].append([opening, content, token])
        else:
            stack[-1].append(token)
    return stack[0]


def is_group(item: object, opening: str = "") -> bool:
    return isinstance(item, list) and (not opening or item[0] == opening)


def number(token: str) -> str:
    return token + "f" if re.search(r"[.eE]", token) and not token.startswith("0x") else token


def swizzle(token: str) -> str | None:
    if not re.fullmatch(r"[xyzw]{1,4}|[rgba]{1,4}", token):
        return None
    return "".join(COMPONENTS.get(c, c) for c in token)


class Translator:
    """Expressions and statements of function bodies."""

    def __init__(self) -> None:
        self.uniforms: set[str] = set()  # features
        self.off: set[str] = set()  # features that are left out

    def is_off(self, items: list) -> bool:
        return len(items) == 1 and not is_group(items[0]) and items[0] in self.off

    def is_uniform(self, items: list) -> bool:
        """Whether only one side of the choice is evaluated: for all pixels the same."""
        return all(not is_group(item) and (item in self.uniforms or not re.match(r"[A-Za-z_.]", item)) for item in items)

    def expression(self, items: list) -> str:
        for i, item in enumerate(items):
            if item == "?":
                depth, j = 0, i + 1
                while depth or items[j] != ":":
                    depth += (items[j] == "?") - (items[j] == ":")
                    j += 1
                parts = items[:i], items[i + 1 : j], items[j + 1 :]
                if self.is_off(parts[0]):
                    return self.expression(parts[2])
                if self.is_uniform(parts[0]):
                    return "({} ? {} : {})".format(*(self.expression(part) for part in parts))
                return "select(" + ", ".join(self.expression(part) for part in parts) + ")"
        return self.plain(items)

    def plain(self, items: list) -> str:
        out, i = [], 0
        while i < len(items):
            item, after = items[i], items[i + 1] if i + 1 < len(items) else None
            if is_group(item):
                out.append(self.group(item))
            elif item == "." and isinstance(after, str) and swizzle(after):
                name = swizzle(after)
                out.append("." + name if len(name) == 1 else f".{name}()")
                i += 1
            elif item in ("float", "int") and is_group(after, "("):
                out.append(f"to_{item}")
            elif item in ("int", "bool"):
                out.append("auto")
            elif item in TYPES:
                out.append(TYPES[item])
            elif re.match(r"[\d.]", item) and item != ".":
                out.append(number(item))
            else:
                out.append(item)
            i += 1
        return " ".join(out)

    def segment(self, items: list) -> str:
        """One statement, argument or initialiser, in which there may be one expression with ?:."""
        first = next((i for i, item in enumerate(items) if item == "?"), None)
        if first is None:
            return self.assigned_swizzle(items) or self.plain(items)
        start = 0
        for i in range(first):
            if is_group(items[i]):
                continue
            if items[i] in ASSIGNMENTS or items[i] in ("return", "else"):
                start = i + 1
            elif items[i] in ("if", "for", "while"):
                start = i + 2
        head = items[:start]
        if start >= 3 and not is_group(items[start - 1]) and items[start - 1] in ASSIGNMENTS:
            rest = self.assigned_swizzle(items)
            if rest:
                return rest
        return " ".join(filter(None, (self.plain(head), self.expression(items[start:]))))

    def assigned_swizzle(self, items: list) -> str | None:
        """`v.xy += e` is `v.set_xy(v.xy() + e)`."""
        if len(items) < 5 or items[1] != "." or is_group(items[3]) or items[3] not in ASSIGNMENTS:
            return None
        name = swizzle(items[2]) if isinstance(items[2], str) else None
        if not name or len(name) == 1:
            return None
        value = self.expression(items[4:])
        if items[3] != "=":
            value = f"{items[0]}.{name}() {items[3][:-1]} ({value})"
        return f"{items[0]}.set_{name}({value})"

    def group(self, group: list) -> str:
        opening, content, closing = group
        if opening == "{":
            return self.block(content)
        out, segment = [], []
        for item in content:
            if item in (",", ";"):
                out.append(self.segment(segment) + item + " ")
                segment = []
            else:
                segment.append(item)
        return opening + "".join(out) + self.segment(segment) + closing

    def discarding(self, items: list) -> str | None:
        """`if (c) discard` of main(): nothing is left to do once no pixel is written."""
        if len(items) != 3 or items[0] != "if" or items[2] != "discard":
            return None
        condition = self.expression(items[1][1])
        return f"written = written && !({condition}); if (!any_lane(written)) return"

    def block(self, content: list) -> str:
        out, segment = ["{\n"], []
        for item in content:
            if item == ";":
                out.append((self.discarding(segment) or self.segment(segment)) + ";\n")
                segment = []
            elif item == ",":
                out.append(self.segment(segment) + ", ")
                segment = []
            elif is_group(item, "{"):
                out.append(self.plain(segment) + " " + self.group(item) + "\n")
                segment = []
            else:
                segment.append(item)
        if segment:
            raise ShaderError("a statement without its end")
        return "".join(out) + "}"

    def parameters(self, content: list) -> str:
        out, parameter = [], []
        for item in [*content, ","]:
            if item != ",":
                parameter.append(item)
                continue
            if parameter:
                out.append(self.parameter(parameter))
            parameter = []
        return ", ".join(out)

    def parameter(self, words: list) -> str:
        by_reference = words[0] in ("out", "inout")
        words = [word for word in words if word not in ("in", "out", "inout", "const")]
        kind, name = words[0], words[1]
        if kind.startswith("sampler"):
            return f"const auto& {name}"
        kind = {"int": "auto", "bool": "auto"}.get(kind, TYPES.get(kind, kind))
        return f"{kind}{'&' if by_reference else ''} {name}"


class Shader:
    """Declarations at file scope."""

    def __init__(self, text: Text, name: str, apart: set[str]) -> None:
        self.apart = apart
        self.uniforms: list[tuple[str, str, str]] = []  # type, name, array size or ""
        self.uniform_structs: list[str] = []
        self.members: list[str] = []
        self.streams: list[tuple[str, str, bool]] = []  # type, name, whether it is written
        self.outputs: dict[int, str] = {}  # by location
        self.functions: list[tuple[str, set[str], str]] = []  # name, what it names, text
        tree = tree_of(tokens_of(text.read(name)))
        self.features = text.features
        structs: dict[str, list] = {}
        translator = Translator()
        translator.uniforms = {constant for _, constant in text.features}
        translator.off = {constant for macro, constant in text.features if macro in text.without}
        items: list = []
        for item in tree:
            items.append(item)
            ends = item == ";" or (is_group(item, "{") and items[0] not in ("struct", "layout", "uniform"))
            if not ends:
                continue
            self.declaration(items, structs, translator)
            items = []
        if items:
            raise ShaderError(f"{name}: a declaration without its end")
        if unknown := apart - {function for function, _, _ in self.functions}:
            raise ShaderError(f"there is no function {', '.join(sorted(unknown))}")

    def declaration(self, items: list, structs: dict, translator: Translator) -> None:
        location, is_blended = 0, False
        if items[0] == "layout":
            words = items[1][1]
            location = int(words[words.index("location") + 2]) if "location" in words else 0
            is_blended = "index" in words and words[words.index("index") + 2] != "0"
            items = items[2:]
        if items[0] in INTERPOLATIONS:
            items = items[1:]
        if items[0] == "struct":
            structs[items[1]] = items[2][1]
            self.members.append(f"struct {items[1]} {translator.block(items[2][1])};")
        elif items[0] == "uniform" and is_group(items[2], "{"):
            kind, name, size = items[2][1][0], items[2][1][1], items[2][1][2][1]
            fields = self.fields(structs[kind])
            self.members = [m for m in self.members if not m.startswith(f"struct {kind} ")]
            self.uniform_structs.append(
                f"struct {kind} {{ " + " ".join(f"{UNIFORM_TYPES[t]} {n};" for t, n in fields) + " };"
            )
            self.uniforms.append((kind, name, size[0]))
        elif items[0] == "uniform":
            self.uniforms.append((items[1], items[2], items[3][1][0] if is_group(items[3], "[") else ""))
        elif items[0] in ("in", "out"):
            names = [item for item in items[2:-1] if item != ","]
            self.members.append(f"{TYPES.get(items[1], items[1])} {', '.join(names)};")
            # A second source of blending and integers are not what pixels become.
            if items[0] == "out" and not is_blended and not items[1].startswith("uvec"):
                self.outputs[location] = items[2]
            self.streams.append((items[1], items[2], items[0] == "out"))
        elif items[0] == "const":
            self.members.append("static constexpr " + UNIFORM_TYPES[items[1]] + " " + self.constant(items[2:-1], translator) + ";")
        else:
            kind, name, parameters, body = items
            kind = TYPES.get(kind, "auto" if kind == "int" else kind)
            how = "APART" if name in self.apart else "INLINE"
            text = f"{how} {kind} {name}({translator.parameters(parameters[1])}) {translator.block(body[1])}"
            self.functions.append((name, set(re.findall(r"\w+", text)), text))

    def called(self) -> list[str]:
        """The functions that main() needs."""
        needed = {"main"}
        while True:
            more = set().union(*(names for name, names, _ in self.functions if name in needed)) | needed
            if more == needed:
                return [text for name, _, text in self.functions if name in needed]
            needed = more

    def output_list(self) -> str:
        """The members that are outputs, for whoever writes the pixels; integers are none of them."""
        channels = ", ".join(f"channels_of({name})" for _, name in sorted(self.outputs.items()))
        count = len(self.outputs)
        return (
            f"static constexpr int output_count = {count}; "
            f"INLINE void outputs(vec4 (&pixel)[{count}]) const {{ const vec4 all[] = {{{channels}}}; "
            f"for (int i = 0; i < {count}; ++i) pixel[i] = all[i]; }}"
        )

    @staticmethod
    def constant(items: list, translator: Translator) -> str:
        """`ring[2] = vec2[](...)` too: a list of values."""
        if len(items) > 5 and is_group(items[1], "[") and is_group(items[4], "["):
            name, size, values = items[0], translator.group(items[1]), translator.group(items[5])
            return re.sub(r"\bvec([234])\b", r"uni::vec\1", f"{name}{size} = {{{values[1:-1]}}}")
        return re.sub(r"\bvec([234])\b", r"uni::vec\1", translator.plain(items))

    @staticmethod
    def fields(content: list) -> list[tuple[str, str]]:
        fields, kind, start = [], "", True
        for item in content:
            if item == ";":
                start = True
            elif start:
                kind, start = item, False
            elif item != ",":
                fields.append((kind, item))
        return fields


def write(path: Path, text: str) -> None:
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


def components_of(kind: str) -> list[str]:
    """What a member of a stream consists of, each an array of its own."""
    if kind == "float":
        return [""]
    if re.fullmatch(r"vec[234]", kind):
        return [f".{c}" for c in "xyzw"[: int(kind[3])]]
    raise ShaderError(f"a stream of {kind}")


def stream_of(name: str, shader: Shader) -> tuple[str, list[str]]:
    """The struct of a shader's arrays, and the members that move lanes from and to them."""
    arrays, loads, stores = [], [], []
    for kind, member, written in shader.streams:
        components = components_of(kind)
        many = len(components) > 1
        arrays.append(f"{'' if written else 'const '}float* {member}{f'[{len(components)}]' if many else ''} = {{}};")
        for i, component in enumerate(components):
            array = f"arrays.{member}{f'[{i}]' if many else ''}"
            if written:
                stores.append(f"store_lanes({array}, at, {member}{component});")
            else:
                loads.append(f"{member}{component} = load_lanes({array}, at);")
    members = [
        f"INLINE void load(const {name}_stream& arrays, size_t at) {{", *loads, "}",
        f"INLINE void store(const {name}_stream& arrays, size_t at) const {{", *stores, "}",
    ]  # fmt: skip
    return "\n".join([f"struct {name}_stream {{", *arrays, "};"]), members


def translate(
    name: str, folder: Path, macros: dict[str, str], without: list[str], apart: set[str], is_stream: bool
) -> tuple[str, str, str]:
    """The struct of a shader's uniforms, that of the shader, and that of its arrays."""
    text = Text(folder, macros, without)
    shader = Shader(text, f"{name}.frag", apart)
    kinds = [
        (f"samplers::{uniform}" if kind.startswith(("sampler", "usampler")) else UNIFORM_TYPES.get(kind, kind), uniform, size)
        for kind, uniform, size in shader.uniforms
    ]
    declared = [f"{kind} {uniform}{f'[{size}]' if size else ''} = {{}};" for kind, uniform, size in kinds]
    declared += [f"bool {constant} = false;" for _, constant in text.features]
    visits = [f'visit("{uniform}", {uniform});' for _, uniform, _ in kinds]
    visits += [f'visit.feature("{macro}", {constant});' for macro, constant in text.features]
    uniforms = [f"struct {name}_uniforms {{", *shader.uniform_structs, *declared]
    uniforms += ["template <class Visitor>", "void visit(Visitor&& visit) {", *visits, "}", "};"]
    stream, moves = stream_of(name, shader) if is_stream else ("", [])
    body = [f"struct {name} : {name}_uniforms, Fragment {{", *shader.members, *shader.called(), *moves]
    body += [shader.output_list(), "};"] if shader.outputs and not is_stream else ["};"]
    return "\n".join(uniforms), "\n".join(body), stream


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, help="of the shaders")
    parser.add_argument("output", type=Path, help="folder to write to")
    parser.add_argument("names", nargs="+", help="fragment shaders, without .frag")
    parser.add_argument("--define", action="append", default=[], metavar="NAME[=VALUE]", help="a macro")
    parser.add_argument("--without", action="append", default=[], metavar="NAME", help="a feature that is left out")
    parser.add_argument("--apart", action="append", default=[], metavar="NAME.FUNCTION", help="is compiled once, not where it is called")
    parser.add_argument("--stream", action="append", default=[], metavar="NAME", help="one more, that shades arrays")
    arguments = parser.parse_args()
    macros = dict((*macro.split("=", 1), "")[:2] for macro in arguments.define)
    uniforms, shaders, streams = [], [], []
    for name in arguments.names + arguments.stream:
        is_stream = name in arguments.stream
        try:
            apart = {word.split(".")[1] for word in arguments.apart if word.split(".")[0] == name}
            parts = translate(name, arguments.folder, macros, arguments.without, apart, is_stream)
        except ShaderError as error:
            sys.exit(f"{name}: {error}")
        uniforms.append(parts[0])
        shaders.append(parts[1])
        if is_stream:
            streams.append(parts[2])
    arguments.output.mkdir(parents=True, exist_ok=True)
    head = "// Made by scripts/native_shaders.py.\n"
    write(arguments.output / "shader_uniforms.h", head + "\n\n".join(uniforms) + "\n")
    write(arguments.output / "shaders.h", head + "\n\n".join(shaders) + "\n")
    write(arguments.output / "shader_streams.h", head + "\n\n".join(streams) + "\n")


if __name__ == "__main__":
    main()

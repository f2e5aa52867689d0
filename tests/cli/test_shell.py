"""What the shell gets from the table of options: completions, manual pages; --open; a user's configuration file."""
import json
import os
import pty
import re
import select
import signal
import subprocess
import time

import pytest

import png
from binary import BINARY

COMMANDS = "render demo info convert compare doctor view serve thumbnail dataset cache completion man".split()


@pytest.fixture(scope="module")
def bash(tmp_path_factory):
    """Completes a command line as bash does; the last word is the one at the cursor."""
    script = tmp_path_factory.mktemp("bash") / "easypbr"
    script.write_bytes(subprocess.run([BINARY, "completion", "bash"], capture_output=True, check=True).stdout)

    def complete(*words):
        code = 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _easypbr; printf "%s\\n" "${COMPREPLY[@]}"'
        done = subprocess.run(["bash", "-c", code, "bash", script, *words], capture_output=True, text=True, timeout=30)
        assert (done.returncode, done.stderr) == (0, "")
        return done.stdout.split()

    return complete


@pytest.mark.parametrize("words, expected", [
    (["easypbr", "re"], ["render"]),
    (["easypbr", "render", "--tonem"], ["--tonemap"]),
    (["easypbr", "render", "--tonemap", "a"], ["aces", "agx"]),
    (["easypbr", "render", "a.ply", "--set", "camera.fov"], ["camera.fov_y_deg="]),
    (["easypbr", "render", "--style", "point_si"], ["point_size=", "point_size_unit="]),
    (["easypbr", "render", "--texture", "nor"], ["normal="]),
    (["easypbr", "render", "--label-map", "city"], ["cityscapes", "cityscapes_train"]),
    (["easypbr", "render", "--layers", "normal_w"], ["normal_world"]),
    (["easypbr", "render", "--bit-depth", ""], ["8", "16"]),
    (["easypbr", "render", "--camera-axes", ""], ["opengl", "opencv"]),
    (["easypbr", "dataset", "--engine", ""], ["local", "ray"]),
    (["easypbr", "completion", ""], ["bash", "zsh", "fish"]),
    (["easypbr", "man", "comp"], ["compare", "completion"]),
    (["easypbr", "--device", ""], ["auto", "gl", "cpu"]),
    (["easypbr", "render", "a.ply", "--device", "g"], ["gl"]),
    (["easypbr", "--device", "cpu", "re"], ["render"]),
    (["easypbr", "--device", "=", "cpu", "re"], ["render"]),  # bash parts words at "="
    (["easypbr", "--device", "cpu", "render", "--tonem"], ["--tonemap"]),
    (["easypbr", "--device", "cpu", "render", "--tonemap", "a"], ["aces", "agx"]),
    (["easypbr", "--devi"], ["--device"]),
    (["easypbr", "render", "--devi"], ["--device"]),
    (["easypbr", "render", "--layers", "depth,normal_w"], ["depth,normal_world"]),
    (["easypbr", "render", "--preset", ""], ["dark", "flat", "paper", "studio"]),
    (["easypbr", "dataset", "--writers", "co"], ["coco", "colmap"]),
    (["easypbr", "dataset", "--writers", "coco,yolo,co"], ["coco,yolo,coco", "coco,yolo,colmap"]),
    (["easypbr", "render", "--tonemap", "=", "a"], ["aces", "agx"]),
    (["easypbr", "render", "--bit-depth", "="], ["8", "16"]),
    (["easypbr", "--device", "=", "g"], ["gl"]),
    (["easypbr", "--device", "="], ["auto", "gl", "cpu"]),
    (["easypbr", "render", "a.ply", "--set", "=", "camera.fov"], ["camera.fov_y_deg="]),
    (["easypbr", "render", "--texture", "=", "nor"], ["normal="]),
    (["easypbr", "render", "--layers", "=", "depth,normal_w"], ["depth,normal_world"]),
    (["easypbr", "render", "--set=camera.fov"], ["--set=camera.fov_y_deg="]),  # "=" is not in COMP_WORDBREAKS
    (["easypbr", "render", "--layers=depth,normal_w"], ["--layers=depth,normal_world"]),
    (["easypbr", "render", "dro"], []),  # bash completes files
    (["easypbr", "render", "--output", "=", "out"], []),
    (["easypbr", "render", "--texture", "base_color", "=", "t"], []),
    (["easypbr", "render", "-o", "out"], []),
])  # fmt: skip
def test_bash_completes(bash, words, expected):
    assert bash(*words) == expected


def test_the_formats_of_data_sets_are_all_completed(bash):
    from easypbr.dataset.writers import WRITERS

    assert set(bash("easypbr", "dataset", "--writers", "")) == set(WRITERS)


def test_the_layers_that_render_takes_are_all_completed(bash, easypbr, sphere):
    names = set(bash("easypbr", "render", "--layers", ""))
    assert {"object_id", "ambient_occlusion", "instances", "distance"} <= names
    easypbr("render", sphere, "-o", "out.png", "--size", "16x16", "--layers", ",".join(sorted(names)))
    error = easypbr("render", sphere, "-o", "out.png", "--layers", "none", code=2).stderr
    assert names == set(error.split("expected ")[1].split(" (see")[0].split(", "))


def test_bash_answers_at_once(bash, tmp_path):
    """50 ms, without bash's own start; nothing of easypbr is started."""
    script = tmp_path / "easypbr"
    script.write_bytes(subprocess.run([BINARY, "completion", "bash"], capture_output=True, check=True).stdout)
    code = ('source "$1"; PATH=; COMP_WORDS=(easypbr render --set camera.fov); COMP_CWORD=3; '
            "begin=${EPOCHREALTIME/./}; for i in {1..20}; do _easypbr; done; echo $(( (${EPOCHREALTIME/./} - begin) / 20 ))")
    done = subprocess.run(["/bin/bash", "-c", code, "bash", script], capture_output=True, text=True, check=True)
    assert int(done.stdout) < 50_000, "microseconds"


@pytest.mark.parametrize("line, expected", [
    ("render --tonemap a", ["aces", "agx"]),
    ("comp", ["compare", "completion"]),
    ("man comp", ["compare", "completion"]),
    ("--device ", ["auto", "cpu", "gl"]),
    ("--device cpu re", ["render"]),
    ("--device cpu render --tonemap a", ["aces", "agx"]),
    ("render --dev", ["--device"]),
    ("render --device ", ["auto", "cpu", "gl"]),
    ("render --layers color,dep", ["color,depth"]),
    ("dataset --writers coco,b", ["coco,bop"]),
    ("info render --j", ["--json"]),
    ("render --tonemap=a", ["--tonemap=aces", "--tonemap=agx"]),
    ("render --set=camera.fov", ["--set=camera.fov_y_deg="]),
    ("render --output=pict", ["--output=picture.png"]),
    ("render --texture nor", ["normal="]),
    ("render --texture base_color=pict", ["base_color=picture.png"]),
    ("render --texture=base_color=pict", ["--texture=base_color=picture.png"]),
])  # fmt: skip
def test_fish_completes(easypbr, tmp_path, line, expected):
    (tmp_path / "picture.png").touch()
    (tmp_path / "easypbr.fish").write_text(easypbr("completion", "fish").stdout)
    home = {**os.environ, "HOME": str(tmp_path), "XDG_CONFIG_HOME": str(tmp_path)}
    code = f"source easypbr.fish; complete -C 'easypbr {line}'"
    done = subprocess.run(["fish", "-c", code], cwd=tmp_path, env=home, capture_output=True, text=True, check=True)
    assert sorted(found.split("\t")[0] for found in done.stdout.splitlines()) == expected


@pytest.fixture(scope="module")
def zsh(tmp_path_factory):
    """What zsh makes of a line when Tab is pressed at its end; Ctrl-T is a Tab that writes the line to a file."""
    folder = tmp_path_factory.mktemp("zsh")
    (folder / "picture.png").touch()
    (folder / "_easypbr").write_bytes(subprocess.run([BINARY, "completion", "zsh"], capture_output=True, check=True).stdout)
    process, terminal = pty.fork()
    if process == 0:
        os.chdir(folder)
        os.execvpe("zsh", ["zsh", "-f", "-i"], {**os.environ, "TERM": "dumb"})
    setup = ("fpath=($PWD $fpath); autoload -U compinit; compinit -u -D; setopt no_beep; LISTMAX=0; "
             "tab() { zle expand-or-complete; print -r -- \"$BUFFER\" > part; mv part line; BUFFER= }; "
             "zle -N tab; bindkey '^T' tab; print ready > part; mv part line\n")

    def wait_for_line():
        end = time.monotonic() + 60
        while not (folder / "line").exists():
            assert time.monotonic() < end
            if select.select([terminal], [], [], 0.02)[0]:
                os.read(terminal, 65536)  # What it shows would fill the terminal.
        line = (folder / "line").read_text().strip()
        (folder / "line").unlink()
        return line

    def complete(line):
        os.write(terminal, line.encode() + b"\x14")
        return wait_for_line()

    os.write(terminal, setup.encode())
    assert wait_for_line() == "ready"
    yield complete
    os.kill(process, signal.SIGKILL)
    os.waitpid(process, 0)
    os.close(terminal)


@pytest.mark.parametrize("line, expected", [
    ("rend", "render"),
    ("--dev", "--device="),  # zsh takes the "=" away again where a space follows
    ("--device c", "--device cpu"),
    ("--device=c", "--device=cpu"),
    ("--device cpu rend", "--device cpu render"),
    ("--device=cpu rend", "--device=cpu render"),
    ("--device cpu render --tonem", "--device cpu render --tonemap="),
    ("render --dev", "render --device="),
    ("render --device c", "render --device cpu"),
    ("render --tonemap ac", "render --tonemap aces"),
    ("render --layers color,dep", "render --layers color,depth,"),
    ("render --tonemap=ac", "render --tonemap=aces"),
    ("render --layers=color,dep", "render --layers=color,depth,"),
    ("render --set camera.fov", "render --set camera.fov_y_deg="),
    ("render --set=camera.fov", "render --set=camera.fov_y_deg="),
    ("render --output pict", "render --output picture.png"),
    ("render --output=pict", "render --output=picture.png"),
    ("render -o pict", "render -o picture.png"),
    ("render --texture base_color=pict", "render --texture base_color=picture.png"),
    ("render --texture=base_color=pict", "render --texture=base_color=picture.png"),
    ("dataset --writers coco,b", "dataset --writers coco,bop,"),
    ("completion z", "completion zsh"),
])  # fmt: skip
def test_zsh_completes(zsh, line, expected):
    assert zsh(f"easypbr {line}") == f"easypbr {expected}"


def test_zsh_takes_it(easypbr, tmp_path):
    (tmp_path / "_easypbr").write_text(easypbr("completion", "zsh").stdout)
    subprocess.run(["zsh", "-n", "_easypbr"], cwd=tmp_path, check=True)
    code = "autoload -U compinit; compinit -u -D; source ./_easypbr; echo $_comps[easypbr]"
    done = subprocess.run(["zsh", "-f", "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert (done.stdout.strip(), done.stderr) == ("_easypbr", "")
    text = (tmp_path / "_easypbr").read_text()
    assert "--tonemap=[Tone mapping operator.]:NAME:(aces reinhard agx neutral none)" in text


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_every_option_is_completed(easypbr, shell):
    script = easypbr("completion", shell).stdout
    for command in COMMANDS:
        assert command in script
        for option in re.findall(r"(?<![\w-])--([a-z][a-z-]*)", easypbr(command, "--help").stdout):
            assert re.search(rf"(--|-l ){option}(?![\w-])", script), (command, option)


def test_unknown_shells_and_commands_are_told(easypbr):
    assert "expected bash, zsh or fish, got 'tcsh'" in easypbr("completion", "tcsh", code=2).stderr
    assert "completion: expected the name of a shell" in easypbr("completion", code=2).stderr
    assert "there is no command 'rendr' (did you mean 'render'?)" in easypbr("man", "rendr", code=2).stderr


def test_manual_pages(easypbr, tmp_path):
    easypbr("man", "--output", "man")
    pages = {path.name for path in (tmp_path / "man").iterdir()}
    assert pages == {"easypbr.1", *(f"easypbr-{command}.1" for command in COMMANDS)}
    for page in (tmp_path / "man").iterdir():
        done = subprocess.run(["groff", "-man", "-Tutf8", "-ww", page], capture_output=True, text=True, check=True)
        assert done.stderr == "", page.name
    shown = subprocess.run(["groff", "-man", "-Tascii", "-P-cbou", "man/easypbr-render.1"], cwd=tmp_path, capture_output=True, text=True).stdout
    words = " ".join(shown.split())
    assert "--tonemap NAME Tone mapping operator. One of aces, reinhard, agx, neutral, none." in words
    assert easypbr("man", "render").stdout == (tmp_path / "man/easypbr-render.1").read_text()
    assert easypbr("man").stdout == (tmp_path / "man/easypbr.1").read_text()


# --open


@pytest.fixture
def opener(environment, tmp_path, monkeypatch):
    """A program xdg-open that writes down what it was given."""
    folder = tmp_path / "bin"
    folder.mkdir()
    program = folder / "xdg-open"
    program.write_text(f'#!/bin/sh\necho "$1" >> {tmp_path}/opened.part\nmv {tmp_path}/opened.part {tmp_path}/opened\n')
    program.chmod(0o755)
    monkeypatch.setitem(environment, "PATH", f"{folder}:/usr/bin:/bin")
    return tmp_path / "opened"


def test_open_shows_the_picture(render, sphere, opener, tmp_path):
    render(sphere, "-o", "out.png", "--open")
    end = time.monotonic() + 10
    while not opener.exists() and time.monotonic() < end:
        time.sleep(0.02)
    assert opener.read_text() == f"{tmp_path}/out.png\n"


def test_open_is_refused_before_anything_is_drawn(render, environment, sphere, tmp_path, monkeypatch):
    assert "--open needs a file" in render(sphere, "-o", "-", "--open", code=2).stderr
    monkeypatch.setitem(environment, "PATH", str(tmp_path))
    assert "--open needs xdg-open in PATH" in render(sphere, "-o", "out.png", "--open", code=1).stderr
    assert not (tmp_path / "out.png").exists()


# The user's configuration file


@pytest.fixture
def configured(environment, tmp_path, monkeypatch):
    """Writes the file."""
    monkeypatch.setitem(environment, "XDG_CONFIG_HOME", str(tmp_path / "config"))

    def write(entries):
        path = tmp_path / "config/easypbr/config.json"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(entries if isinstance(entries, str) else json.dumps(entries))
        return path

    return write


def corner(path):
    return tuple(png.read(path)[0, 0, :3])


def test_defaults_by_pattern(render, configured, sphere, box, tmp_path):
    configured([
        {"files": "*.obj", "settings": {"background.color": "#ff0000", "image.size": [32, 24]}},
        {"files": "box.*, *.pcd", "settings": {"background.color": [0, 0, 1]}},
        {"files": "*.stl", "settings": {"background.color": "#00ff00"}},
    ])
    render(sphere, "-o", "sphere.png")
    render(box, "-o", "box.png")
    assert corner(tmp_path / "sphere.png") == (255, 0, 0) and corner(tmp_path / "box.png") == (0, 0, 255)
    render(sphere, box, "--batch", "-o", "batch-{name}.png")
    for name in ("sphere", "box"):
        assert (tmp_path / f"batch-{name}.png").read_bytes() == (tmp_path / f"{name}.png").read_bytes()


@pytest.mark.parametrize("file, fits", [
    ("s1/t.obj", True), ("./s1/t.obj", True), ("s2/../s1/t.obj", True), ("s1//t.obj", True), ("s2/./.././s1/t.obj", True),
    ("s1/../s2/t.obj", False), ("s2/t.obj", False), ("link/t.obj", False), ("s1/link.obj", True),
])  # fmt: skip
def test_patterns_of_paths_fit_however_a_path_is_written(render, configured, sphere, tmp_path, file, fits):
    """Links are not followed: link is s1, and s1/link.obj is s2/t.obj."""
    for folder in ("s1", "s2"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "t.obj").write_bytes(sphere.read_bytes())
    (tmp_path / "link").symlink_to("s1")
    (tmp_path / "s1/link.obj").symlink_to("../s2/t.obj")
    configured([{"files": f"{tmp_path}/s1/*", "settings": {"background.color": "#ff0000"}}])
    render(file, "-o", "out.png")
    assert (corner(tmp_path / "out.png") == (255, 0, 0)) == fits


def test_options_and_settings_files_come_after_it(easypbr, render, configured, sphere, tmp_path):
    render(sphere, "-o", "plain.png", "--save-settings", "plain.json")
    configured([{"settings": {"background.color": "#ff0000"}}])
    render(sphere, "-o", "red.png")
    render(sphere, "-o", "green.png", "--background", "#00ff00")
    render(sphere, "-o", "file.png", "--settings", "plain.json")
    assert corner(tmp_path / "red.png") == (255, 0, 0) and corner(tmp_path / "green.png") == (0, 255, 0)
    assert (tmp_path / "file.png").read_bytes() == (tmp_path / "plain.png").read_bytes()
    easypbr("view", sphere, "--size", "1000x600", "--set", "image.samples=1", "--screenshot", "view.png")
    assert (255, 0, 0) in {tuple(pixel) for pixel in png.read(tmp_path / "view.png")[::7, ::7, :3].reshape(-1, 3)}


def test_another_file_or_none_by_the_environment(render, environment, configured, sphere, tmp_path, monkeypatch):
    configured([{"settings": {"background.color": "#ff0000"}}])
    (tmp_path / "mine.json").write_text(json.dumps([{"settings": {"background.color": "#00ff00"}}]))
    monkeypatch.setitem(environment, "EASYPBR_CONFIG", str(tmp_path / "mine.json"))
    render(sphere, "-o", "mine.png")
    assert corner(tmp_path / "mine.png") == (0, 255, 0)
    monkeypatch.setitem(environment, "EASYPBR_CONFIG", "")
    render(sphere, "-o", "none.png")
    assert corner(tmp_path / "none.png") not in {(255, 0, 0), (0, 255, 0)}
    monkeypatch.setitem(environment, "EASYPBR_CONFIG", str(tmp_path / "missing.json"))
    assert "missing.json" in render(sphere, "-o", "a.png", code=1).stderr


@pytest.mark.parametrize("entries, message", [
    ("[{", "cannot read .*config.json, line 1, column 3: expected JSON, got the end of the text"),
    ({"files": "*"}, "expected a list of entries"),
    ([3], "entry 1: expected {\"files\": "),
    ([{"settings": {}}, {"match": "*", "settings": {}}], "entry 2: there is no 'match': expected files and settings"),
    ([{"files": "*"}], "entry 1: expected settings"),
    ([{"files": 3, "settings": {}}], "entry 1: files: expected a pattern"),
    ([{"files": "*.never", "settings": {"image.sampels": 4}}], "entry 1: there is no setting 'image.sampels' .did you mean 'image.samples'"),
    ([{"settings": {"image.samples": "many"}}], "entry 1: setting 'image.samples': expected a whole number"),
    ([{"settings": {"image.size": {"x": 3}}}], "entry 1: setting 'image.size': expected 2 numbers, each .*, got {\"x\":3}"),
    ([{"settings": {"camera.position": ["a"]}}], r"""entry 1: setting 'camera.position': expected 3 numbers, or 'auto' or 'follow', got \["a"\]"""),
    ([{"settings": {"background.color": "whte"}}], "entry 1: setting 'background.color': expected a colour: .*, got 'whte' .did you mean 'white'"),
])  # fmt: skip
def test_mistakes_name_the_file_and_the_entry(render, configured, sphere, entries, message):
    path = configured(entries)
    stderr = render(sphere, "-o", "a.png", code=1).stderr
    assert str(path) in stderr and re.search(message, stderr), stderr


# Words of other programs


@pytest.mark.parametrize("option, hint", [
    ("--base-color", "it is called --color"),
    ("--camera-focal-point", "it is called --camera-target"),
    ("--hdri", "it is called --env"),
    ("--point-size", "it is called --set style.point_size=VALUE"),
    ("--show-edges", "it is called --set style.show_wireframe=VALUE"),
    ("--scalar-bar", "it is called --colorbar"),
    ("--bg-color", "it is called --background"),
    ("--volume", "volumes are not drawn"),
    ("--mesh-show-back-face", "it is called --set style.two_sided=VALUE"),
    ("--window-name", "windows are titled by the files that they show"),
    ("--film-transparent", "it is called --background"),
    ("--rougness", "did you mean '--roughness'"),
])  # fmt: skip
def test_words_of_other_programs_are_known(render, sphere, option, hint):
    stderr = render(sphere, "-o", "a.png", option, "1", code=2).stderr
    assert f"unknown option '{option}'" in stderr and hint in stderr


def test_synonyms_of_settings_are_told(render, sphere):
    stderr = render(sphere, "-o", "a.png", "--set", "camera.fov=30", code=2).stderr
    assert "there is no setting 'camera.fov' (it is called 'camera.fov_y_deg')" in stderr


def test_dataset_without_the_package_says_so_in_one_line(easypbr, environment, monkeypatch, tmp_path):
    """A Python without easypbr: this one, kept from its own packages."""
    python = tmp_path / "python"
    python.write_text('#!/bin/sh\nexec /usr/bin/python3 -I -S "$@"\n')
    python.chmod(0o755)
    monkeypatch.setitem(environment, "EASYPBR_PYTHON", str(python))
    done = easypbr("dataset", "--demo", "-o", "out", code=1)
    (line,) = done.stderr.splitlines()
    assert line.startswith("easypbr: error: dataset: ") and "has no module easypbr" in line and "pip install easypbr" in line

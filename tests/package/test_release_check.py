"""scripts/release_check.py finds what it is there to find: each check once with a fault."""

import copy
import subprocess
import sys

import pytest

from test_package import ROOT

sys.path.insert(0, str(ROOT / "scripts"))
import release_check  # noqa: E402
import write_licenses  # noqa: E402


@pytest.fixture
def tree(tmp_path):
    """A repository of files by their names."""
    def write(**files):
        for name, text in files.items():
            (tmp_path / name.replace("_", ".")).write_text(text)
        for command in (["init", "-q"], ["add", "-A"]):
            subprocess.run(["git", *command], cwd=tmp_path, check=True)
        return tmp_path

    return write


def test_the_cheap_parts_pass_here():
    for part in ("version", "citation", "licenses", "sbom"):
        assert release_check.PARTS[part]()


def test_a_second_place_of_the_version_is_found(tree):
    folder = tree(CMakeLists_txt="project(a VERSION 1.2.3)", a_json='{"version": "1.2.3"}', b_py='__version__ = "1.2.3"',
                  c_txt="version 1.2.34, VERSION 0.1.2.3", d_md="we like 1.2.3")  # fmt: skip
    assert release_check.places_of("1.2.3", folder) == ["CMakeLists.txt", "a.json", "b.py"]


@pytest.mark.parametrize("text, fault", [
    ("cff-version: 1.2.0\ntitle: a\n", "lacks authors, license, message, type"),
    ("cff-version: 1\nmessage: a\ntitle: a\nlicense: MIT\ntype: software\nauthors: [{name: a}]\nversion: 1\n", "states a version"),
    ("cff-version: 1\nmessage: a\ntitle: a\nlicense: MIT\ntype: software\nauthors: [{email: a}]\n", "an author has no name"),
])  # fmt: skip
def test_citations_that_are_incomplete(tmp_path, text, fault):
    (tmp_path / "CITATION.cff").write_text(text)
    with pytest.raises(release_check.Fault, match=fault):
        release_check.check_citation(tmp_path / "CITATION.cff")
    with pytest.raises(release_check.Fault, match="is missing"):
        release_check.check_citation(tmp_path / "none.cff")


def test_a_library_without_a_licence_is_found(monkeypatch):
    monkeypatch.setattr(write_licenses, "BUNDLED", [name for name in write_licenses.BUNDLED if name != "libspng0"])
    with pytest.raises(release_check.Fault, match="does not know: .*libspng"):
        release_check.check_licenses()


def test_faults_of_the_list_of_contents():
    good = write_licenses.sbom()
    for change, fault in (
        (lambda d: d.pop("creationInfo"), "lacks creationInfo"),
        (lambda d: d.update(spdxVersion="SPDX-2.2"), "is SPDX-2.2"),
        (lambda d: d["packages"].append(d["packages"][0]), "have one SPDXID"),
        (lambda d: d["packages"].pop(), "relates what it does not list"),
        (lambda d: d["packages"][0].update(SPDXID="SPDXRef-a b"), "letters that SPDX does not allow"),
    ):
        document = copy.deepcopy(good)
        change(document)
        with pytest.raises(release_check.Fault, match=fault):
            release_check.check_sbom(document)


def test_dead_links_and_anchors_are_found(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "index.html").write_text('<a href="a/">x</a><a href="a/#there">x</a><a href="a/#gone">x</a><a href="https://b.c/">x</a>')
    (tmp_path / "a/index.html").write_text('<h1 id="there">x</h1><img src="../none.png"><a href="#there">x</a><a href="#no">x</a>')
    assert sorted(release_check.dead_links(tmp_path)) == [
        "a/index.html: #no: no such anchor", "a/index.html: ../none.png", "index.html: a/#gone: no such anchor"]  # fmt: skip


@pytest.fixture
def library(tmp_path):
    """A library of a header and its source, compiled with debug information."""
    def make(name, header, source):
        folder = tmp_path / name
        folder.mkdir()
        (folder / "a.h").write_text(header)
        (folder / "a.cpp").write_text('#include "a.h"\n' + source)
        command = ["g++", "-g", "-shared", "-fPIC", "-Wl,-soname,liba.so", "a.cpp", "-o", "liba.so"]
        subprocess.run(command, cwd=folder, check=True)
        return folder / "liba.so", folder

    return make


HEADER = "struct Size {{ int width, height{more}; }};\nint area(const Size& size);\n{other}"
AREA = "int area(const Size& size) { return size.width * size.height; }\n"


def test_the_abi_of_headers(library):
    old = library("old", HEADER.format(more="", other="int two();\n"), AREA + "int two() { return 2; }\n")
    same = library("same", HEADER.format(more="", other="int two();\n"), AREA + "int two() { return 1 + 1; }\n")
    added = library("added", HEADER.format(more="", other="int two();\nint three();\n"), AREA + "int two() { return 2; }\nint three() { return 3; }\n")
    gone = library("gone", HEADER.format(more="", other=""), AREA)
    larger = library("larger", HEADER.format(more=", depth", other="int two();\n"), AREA + "int two() { return 2; }\n")
    broken = {new[1].name: release_check.abi_changes(old, new)[0] for new in (same, added, gone, larger)}
    assert broken == {"same": False, "added": False, "gone": True, "larger": True}


def test_parts_run_alone_and_unknown_ones_are_told(monkeypatch, capsys):
    monkeypatch.setitem(release_check.PARTS, "citation", lambda: "good")

    def bad():
        raise release_check.Fault("for this reason")

    monkeypatch.setitem(release_check.PARTS, "sbom", bad)
    assert release_check.main(["citation"]) == 0 and capsys.readouterr().out == "citation: good\n"
    assert release_check.main(["sbom", "citation"]) == 1
    assert capsys.readouterr().out == "sbom: FAILED: for this reason\ncitation: good\n"
    assert release_check.main(["citatoin"]) == 2 and "there is no part citatoin: expected version, citation" in capsys.readouterr().err

#!/usr/bin/env python3
"""Checks what a release needs, part by part, each of which can run alone. Prints a line for each part; exit code 1 when one fails.

usage: release_check.py [PART ...]      all by default, in this order:
  version    one place says the version, programs and package agree with it, a tag of HEAD and CHANGELOG.md too
  citation   CITATION.cff is complete
  licenses   there is a licence for everything that is bundled or compiled in
  sbom       the list of contents is SPDX 2.3 and names them all
  abi        the library against the one of the last tag, by abidiff; builds both with debug information
  docs       builds the site; no link inside it leads nowhere, anchors included
  sdist      builds the source distribution, which holds what a build needs
  wheels     builds the wheels (minutes)
  outside    tests the wheels from outside; needs root
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import urllib.parse
from collections.abc import Callable
from html.parser import HTMLParser

import write_licenses
import yaml

ROOT = pathlib.Path(__file__).resolve().parents[1]
#: Files that name versions of the past, or of others.
NOT_THE_VERSION = {"CHANGELOG.md", "web/package-lock.json"}
#: Debian packages of libraries that every system for wheels has (manylinux), or that are loaded where they are there.
SYSTEM = {"libc6", "libgcc-s1", "libstdc++6", "libavcodec59", "libavformat59", "libavutil57", "libswscale6"}


class Fault(Exception):
    """What keeps a release back."""


def run(*command: str | pathlib.Path, cwd: pathlib.Path = ROOT) -> str:
    done = subprocess.run(list(map(str, command)), cwd=cwd, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise Fault(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def require(condition: object, fault: str) -> None:
    if not condition:
        raise Fault(fault)


# Version.


def places_of(version: str, root: pathlib.Path = ROOT) -> list[str]:
    """Tracked files that state a version as theirs, as JSON, CMake, Python and YAML do."""
    pattern = re.compile(rf"version[\W_]{{1,8}}{re.escape(version)}(?![\d.])", re.IGNORECASE)
    found = []
    for name in run("git", "ls-files", cwd=root).splitlines():
        path = root / name
        if name in NOT_THE_VERSION or not path.is_file() or path.stat().st_size > 1_000_000:
            continue
        if pattern.search(path.read_text(encoding="utf-8", errors="ignore")):
            found.append(name)
    return found


def check_version() -> str:
    version = write_licenses.version_of_project()
    places = places_of(version)
    require(places == ["CMakeLists.txt"], f"the version {version} stands in {', '.join(places)}: expected CMakeLists.txt alone")
    told = run(ROOT / "build/easypbr", "--version").strip()
    require(version in told, f"build/easypbr says '{told}', CMakeLists.txt {version}")
    package = run(sys.executable, "-c", "import easypbr; print(easypbr.__version__)").strip()
    require(package == version, f"the package says {package}, CMakeLists.txt {version}")
    changes = (ROOT / "CHANGELOG.md").read_text()
    tags = run("git", "tag", "--points-at", "HEAD", "v*").split()
    for tag in tags:
        require(tag == f"v{version}", f"HEAD has the tag {tag}, CMakeLists.txt says {version}")
        require(f"\n## [{version}] - " in changes, f"CHANGELOG.md has no heading '## [{version}] - DATE'")
    require("\n## [Unreleased]" in changes or tags, "CHANGELOG.md has no heading '## [Unreleased]'")
    return version


def check_citation(path: pathlib.Path = ROOT / "CITATION.cff") -> str:
    require(path.exists(), f"{path.name} is missing")
    content = yaml.safe_load(path.read_text())
    missing = {"cff-version", "message", "title", "authors", "license", "type"} - set(content)
    require(not missing, f"{path.name} lacks {', '.join(sorted(missing))}")
    require("version" not in content, f"{path.name} states a version, which stands in CMakeLists.txt alone")
    require(all(author.get("name") or author.get("family-names") for author in content["authors"]), f"{path.name}: an author has no name")
    return str(content["title"])


# Licences and contents.


def linked_packages(binary: pathlib.Path) -> dict[str, set[str]]:
    """Of each library that a binary asks for itself the Debian packages that have a file of its name."""
    needed = re.findall(r"NEEDED\s+(\S+)", run("objdump", "-p", binary))
    places = dict(re.findall(r"^\s*(\S+) => (/\S+)", run("ldd", binary), re.MULTILINE))
    found = {}
    for name in needed:
        if name not in places or str(ROOT) in places[name]:
            continue
        # Packages name files below /usr, which the loader may know by the link /lib.
        owners = run("dpkg", "-S", f"*/{pathlib.Path(places[name]).resolve().name}")
        found[name] = {line.split(":")[0] for line in owners.splitlines()}
    return found


def check_licenses() -> str:
    with tempfile.TemporaryDirectory() as folder:
        write_licenses.write(pathlib.Path(folder) / "licenses")
        count = len(list((pathlib.Path(folder) / "licenses").iterdir()))
    binaries = [path for pattern in ("libeasypbr.so.*.*.*", "libeasypbr_*.so", "easypbr_read_assimp", "easypbr")
                for path in (ROOT / "build").glob(pattern) if path.is_file()]  # fmt: skip
    require(binaries, "build/ holds no library: run make build")
    for binary in binaries:
        unknown = {name: sorted(owners) for name, owners in linked_packages(binary).items()
                   if not owners & {*write_licenses.BUNDLED, *SYSTEM}}  # fmt: skip
        require(not unknown, f"{binary.name} is linked to what scripts/write_licenses.py does not know: {unknown}")
    texts = {path.stem.lower() for path in (ROOT / "LICENSES").glob("*.txt")}
    for name in json.loads((ROOT / "web/package.json").read_text()).get("dependencies", {}):
        require(name.lower() in texts, f"LICENSES has no text for {name}, which web/dist bundles")
    for wheel in sorted((ROOT / "dist").glob("easypbr-*.whl")):
        faults = write_licenses.unknown_of(wheel)
        require(not faults, f"{wheel.name}: bundled without a licence: {'; '.join(faults)}")
    return f"{count + len(texts)} texts, {len(binaries)} binaries"


def check_sbom(document: dict | None = None) -> str:
    document = write_licenses.sbom() if document is None else document
    fields = ("spdxVersion", "dataLicense", "SPDXID", "name", "documentNamespace", "creationInfo", "packages", "relationships")
    missing = [field for field in fields if field not in document]
    require(not missing, f"the SBOM lacks {', '.join(missing)}")
    require(document["spdxVersion"] == "SPDX-2.3", f"the SBOM is {document['spdxVersion']}, expected SPDX-2.3")
    ids = [package["SPDXID"] for package in document["packages"]]
    require(len(ids) == len(set(ids)), "two packages of the SBOM have one SPDXID")
    require(all(re.fullmatch(r"SPDXRef-[A-Za-z0-9.-]+", name) for name in ids), "an SPDXID has letters that SPDX does not allow")
    known = {*ids, "SPDXRef-DOCUMENT"}
    for relation in document["relationships"]:
        ends = {relation["spdxElementId"], relation["relatedSpdxElement"]}
        require(ends <= known, f"the SBOM relates what it does not list: {', '.join(ends - known)}")
    listed = {package["name"] for package in document["packages"]}
    absent = {*write_licenses.BUNDLED, *write_licenses.COMPILED, "easypbr", "nanobind"} - listed
    require(not absent, f"the SBOM does not name {', '.join(sorted(absent))}")
    return f"{len(ids)} packages"


# The C++ ABI.


def library_with_symbols(source: pathlib.Path, build: pathlib.Path) -> pathlib.Path:
    options = ["-DCMAKE_CXX_FLAGS=-g", "-DEASYPBR_BUILD_PYTHON=OFF", "-DEASYPBR_BUILD_TESTS=OFF", "-DEASYPBR_BUILD_BENCH=OFF"]
    run("cmake", "-S", source, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", *options)
    run("cmake", "--build", build, "--target", "easypbr")
    return (build / "libeasypbr.so").resolve()


def abi_changes(old: tuple[pathlib.Path, pathlib.Path], new: tuple[pathlib.Path, pathlib.Path]) -> tuple[bool, str]:
    """Of (library, folder of its public headers) each: whether programs that were compiled with the old one may fail, and abidiff's report."""
    require(shutil.which("abidiff"), "abidiff is not installed: Debian's abigail-tools has it")
    command = ["abidiff", "--headers-dir1", old[1], "--headers-dir2", new[1], "--drop-private-types", old[0], new[0]]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
    # Bits of the exit code: 1 error, 2 usage, 4 change, 8 incompatible change (abidiff's manual).
    require(done.returncode & 3 == 0, f"abidiff: {done.stdout}{done.stderr}")
    removed = re.search(r"(?:^|[ ,:])([1-9]\d*) Removed", done.stdout)
    # What it calls a change may be an addition; removed and changed functions and types are what programs notice.
    changed = re.search(r"(?:^|[ ,:])([1-9]\d*) Changed", done.stdout)
    return bool(done.returncode & 8 or removed or changed), done.stdout


def check_abi() -> str:
    tags = run("git", "tag", "--merged", "HEAD", "--sort=-version:refname", "v*").split()
    head = set(run("git", "tag", "--points-at", "HEAD").split())
    earlier = [tag for tag in tags if tag not in head]
    if not earlier:
        return "there is no earlier tag: nothing to compare with"
    tag, version = earlier[0], write_licenses.version_of_project()
    folder = ROOT / "build-abi"
    source = folder / tag / "source"
    if not source.exists():
        source.parent.mkdir(parents=True, exist_ok=True)
        archive = source.parent / "source.tar"
        run("git", "archive", "-o", archive, tag)
        with tarfile.open(archive) as packed:
            packed.extractall(source)
    libraries = [(library_with_symbols(root, build), root / "include") for root, build in
                 ((source, folder / tag / "build"), (ROOT, folder / "head"))]  # fmt: skip
    breaks, report = abi_changes(libraries[0], libraries[1])
    # Versions of one minor number are one ABI (cmake/install.cmake, SameMinorVersion).
    may_break = tag.lstrip("v").split(".")[:2] != version.split(".")[:2]
    require(not breaks or may_break, f"the ABI of {tag} is broken, and {version} promises it:\n{report}")
    return f"against {tag}: " + ("changed, as another minor version may" if breaks else "kept")


# The documentation.


class Links(HTMLParser):
    """Targets of a page, and its anchors."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.targets: list[str] = []
        self.anchors: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = dict(attrs)
        self.anchors |= {value for name in ("id", "name") if (value := values.get(name))}
        for name in ("href", "src"):
            if value := values.get(name):
                self.targets.append(value)


def dead_links(site: pathlib.Path) -> list[str]:
    """Links of the site's pages that lead to no file, or to no anchor of a page. Addresses of other hosts are not asked."""
    pages = {path: Links(path.read_text(encoding="utf-8")) for path in site.rglob("*.html")}
    dead = []
    for path, page in pages.items():
        for target in page.targets:
            parts = urllib.parse.urlsplit(target)
            if parts.scheme or parts.netloc or path.name == "404.html":
                continue
            place = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path.resolve()
            place = place / "index.html" if place.is_dir() else place
            if not place.exists():
                dead.append(f"{path.relative_to(site)}: {target}")
            elif parts.fragment and place in pages and urllib.parse.unquote(parts.fragment) not in pages[place].anchors:
                dead.append(f"{path.relative_to(site)}: {target}: no such anchor")
    return dead


def check_docs() -> str:
    run(ROOT / "scripts/docs.sh")
    site = (ROOT / "site").resolve()
    dead = dead_links(site)
    require(not dead, "dead links:\n" + "\n".join(dead))
    require((site / "llms.txt").exists(), "the site has no llms.txt")
    return f"{len(list(site.rglob('*.html')))} pages, no dead link; links to other hosts were not followed"


# Distributions.


def check_sdist() -> str:
    script = "import sys; from scikit_build_core.build import build_sdist; print(build_sdist(sys.argv[1]))"
    target = ROOT / "dist"
    target.mkdir(exist_ok=True)
    name = run(sys.executable, "-c", script, target).split()[-1]
    with tarfile.open(target / name) as archive:
        names = {member.partition("/")[2] for member in archive.getnames()}
    tracked = set(run("git", "ls-files", "CMakeLists.txt", "cmake", "src", "include", "shaders", "python", "LICENSE", "LICENSES", "web/dist").splitlines())
    missing = sorted(file for file in tracked if (ROOT / file).exists() and file not in names)
    require(not missing, f"{name} lacks {', '.join(missing[:5])}")
    strange = sorted(file for file in names if re.match(r"(build|dist|site|\.venv)", file))
    require(not strange, f"{name} holds {', '.join(strange[:5])}")
    version = write_licenses.version_of_project()
    require(f"-{version}." in name, f"{name} is not of version {version}")
    return f"{name}, {(target / name).stat().st_size / 1e6:.1f} MB"


def check_wheels() -> str:
    run(ROOT / "scripts/wheel.sh")
    return ", ".join(path.name for path in sorted((ROOT / "dist").glob("*.whl")))


def check_outside() -> str:
    require(os.geteuid() == 0, "testing wheels from outside needs root")
    run(ROOT / "scripts/test_wheel.sh")
    return "fresh environments and a bare system"


PARTS: dict[str, Callable[[], str]] = {
    "version": check_version, "citation": check_citation, "licenses": check_licenses, "sbom": check_sbom, "abi": check_abi,
    "docs": check_docs, "sdist": check_sdist, "wheels": check_wheels, "outside": check_outside,
}  # fmt: skip


def main(parts: list[str]) -> int:
    unknown = [part for part in parts if part not in PARTS]
    if unknown or "--help" in parts:
        print(__doc__ if "--help" in parts else f"there is no part {unknown[0]}: expected {', '.join(PARTS)}", file=sys.stderr)
        return 0 if "--help" in parts else 2
    failed = 0
    for part in parts or list(PARTS):
        try:
            print(f"{part}: {PARTS[part]()}", flush=True)
        except (Fault, SystemExit) as fault:
            print(f"{part}: FAILED: {fault}", flush=True)
            failed = 1
    return failed


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

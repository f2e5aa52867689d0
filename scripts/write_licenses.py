#!/usr/bin/env python3
"""Collects the licences of what a wheel contains of others: of the libraries that are bundled and of those that are
compiled in, as their Debian packages and nanobind state them.

usage: write_licenses.py FOLDER            writes one text each, and those of the licences that they refer to
       write_licenses.py --sbom FILE       writes a list of them with versions: SPDX 2.3 in JSON
       write_licenses.py --check WHEEL     exit code 1 when a bundled library is of none of the packages below
"""
import datetime
import importlib.metadata
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import uuid
import zipfile

#: Debian packages of the libraries that auditwheel bundles, and of what they are linked to.
BUNDLED = ["libfmt9", "libtbb12", "libmeshoptimizer2d", "libembree3-3", "libepoxy0", "libspng0", "libturbojpeg0",
           "libwebp7", "libtinyexr1d", "zlib1g", "libyaml-cpp0.7", "libassimp5", "libdraco7", "libminizip1"]
#: Debian packages of what is compiled in: headers, archives, a font.
COMPILED = ["libeigen3-dev", "libfmt-dev", "nlohmann-json3-dev", "libcli11-dev", "libxxhash-dev", "libfast-float-dev",
            "libnanoflann-dev", "libzstd-dev", "libboost1.74-dev", "libimgui-dev", "libstb-dev", "libglfw3-dev", "libxcb1-dev",
            "fonts-dejavu-core"]
COMMON = pathlib.Path("/usr/share/common-licenses")


def copyright_of(package: str) -> pathlib.Path:
    path = pathlib.Path("/usr/share/doc") / package / "copyright"
    if not path.exists():
        sys.exit(f"write_licenses: {path} is missing: is {package} installed?")
    return path


def write(folder: pathlib.Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    common = set()
    for package in BUNDLED + COMPILED:
        text = copyright_of(package).read_text(encoding="utf-8")
        (folder / f"{package}.txt").write_text(text, encoding="utf-8")
        common |= set(re.findall(rf"{COMMON}/([\w.-]*\w)", text))
    for name in common:
        (folder / f"{name}.txt").write_bytes((COMMON / name).read_bytes())
    files = [file for file in importlib.metadata.files("nanobind") or [] if file.name == "LICENSE"]
    for file in files[:1]:
        (folder / "nanobind.txt").write_text(file.read_text(encoding="utf-8"), encoding="utf-8")
    if not files:
        sys.exit("write_licenses: nanobind is installed without its licence")


def version_of_project() -> str:
    text = (pathlib.Path(__file__).parents[1] / "CMakeLists.txt").read_text(encoding="utf-8")
    found = re.search(r"project\(easypbr VERSION ([0-9.]+)", text)
    assert found
    return found[1]


def version_of(package: str) -> str:
    asked = subprocess.run(["dpkg-query", "-W", "-f=${Version}", package], capture_output=True, text=True, check=False)
    if asked.returncode != 0 or not asked.stdout:
        sys.exit(f"write_licenses: {package} is not installed")
    return asked.stdout


def sbom() -> dict[str, object]:
    """What a wheel contains, as SPDX 2.3 names it (clauses 6, 7 and 11). SOURCE_DATE_EPOCH sets its time."""
    version = version_of_project()
    time = datetime.datetime.fromtimestamp(int(os.environ.get("SOURCE_DATE_EPOCH", "0")) or
                                           datetime.datetime.now().timestamp(), datetime.timezone.utc)

    def package(name: str, version: str, declared: str = "NOASSERTION", place: str | None = None) -> dict[str, object]:
        named: dict[str, object] = {"SPDXID": f"SPDXRef-{name.replace('_', '-')}", "name": name, "versionInfo": version,
                                    "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
                                    "licenseConcluded": "NOASSERTION", "licenseDeclared": declared,
                                    "copyrightText": "NOASSERTION"}
        if place:
            named["externalRefs"] = [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                                      "referenceLocator": f"{place}/{name}@{version}"}]
        return named

    others = [package(name, version_of(name), place="pkg:deb/debian") for name in BUNDLED + COMPILED]
    others.append(package("nanobind", importlib.metadata.version("nanobind"), "BSD-3-Clause", "pkg:pypi"))
    relations = [("SPDXRef-DOCUMENT", "DESCRIBES", "SPDXRef-easypbr")]
    relations += [("SPDXRef-easypbr", "CONTAINS", str(other["SPDXID"])) for other in others]
    return {
        "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT",
        "name": f"easypbr-{version}", "documentNamespace": f"https://spdx.org/spdxdocs/easypbr-{version}-{uuid.uuid4()}",
        "creationInfo": {"created": time.strftime("%Y-%m-%dT%H:%M:%SZ"), "creators": ["Tool: write_licenses.py"]},
        "packages": [package("easypbr", version, "MIT"), *others],
        "relationships": [{"spdxElementId": a, "relationshipType": kind, "relatedSpdxElement": b} for a, kind, b in relations],
    }


def bundled_in(wheel: pathlib.Path) -> list[str]:
    """Names of the libraries as the system has them: "libfmt-1a2b3c4d.so.9.1.0" is its libfmt.so.9.1.0."""
    names = [pathlib.PurePosixPath(name) for name in zipfile.ZipFile(wheel).namelist()]
    return [re.sub(r"-[0-9a-f]{8}(?=\.so)", "", name.name) for name in names if name.parent.name == "easypbr.libs"]


def unknown_of(wheel: pathlib.Path) -> list[str]:
    unknown = []
    for name in bundled_in(wheel):
        found = subprocess.run(["dpkg", "-S", f"*/{name}"], capture_output=True, text=True, check=False).stdout
        owners = {line.split(":")[0] for line in found.splitlines()}
        if not owners & set(BUNDLED):
            unknown.append(f"{name} of {', '.join(sorted(owners)) or 'no package'}")
    return unknown


if __name__ == "__main__":
    if len(sys.argv) == 3 and sys.argv[1] == "--check":
        if not bundled_in(pathlib.Path(sys.argv[2])):
            sys.exit(f"{sys.argv[2]} bundles no library: was it repaired?")
        if faults := unknown_of(pathlib.Path(sys.argv[2])):
            sys.exit("bundled without a licence: " + "; ".join(faults))
    elif len(sys.argv) == 3 and sys.argv[1] == "--sbom":
        target = pathlib.Path(sys.argv[2])
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(json.dumps(sbom(), indent=1) + "\n", encoding="utf-8")
    elif len(sys.argv) == 2:
        write(pathlib.Path(sys.argv[1]))
    else:
        sys.exit(__doc__)

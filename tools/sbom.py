"""Writes a software bill of materials as SPDX 2.3 (JSON): the files of the source tree, the
libraries that programs are linked with, and what builds and tests them.

    python3 tools/sbom.py FILE

Run from the project's root, a git repository. The same commit on the same machine gives the same
bytes. Versions of Debian packages are those installed; the date is SOURCE_DATE_EPOCH (seconds) or
that of the last commit.
SPDX-License-Identifier: BSD-2-Clause"""
import datetime
import fnmatch
import hashlib
import json
import os
import re
import subprocess
import sys
import urllib.parse
import uuid

NOTHING = "NOASSERTION"
# Packages of the Makefile's DEPS: their relation to our package, and their licence.
DEPENDENCIES = {
    "gcc": ("BUILD_TOOL_OF", "GPL-3.0-or-later WITH GCC-exception-3.1"),
    "libc6-dev": ("BUILD_DEPENDENCY_OF", "LGPL-2.1-or-later"),
    "libcmocka-dev": ("TEST_DEPENDENCY_OF", "Apache-2.0"),
    "libjansson-dev": ("BUILD_DEPENDENCY_OF", "MIT"),
    "libjpeg-dev": ("BUILD_DEPENDENCY_OF", "IJG AND BSD-3-Clause AND Zlib"),
    "libpng-dev": ("BUILD_DEPENDENCY_OF", "libpng-2.0"),
    "libxxhash-dev": ("BUILD_DEPENDENCY_OF", "BSD-2-Clause"),
    "python3": ("TEST_DEPENDENCY_OF", "PSF-2.0"),
    "zlib1g-dev": ("BUILD_DEPENDENCY_OF", "Zlib"),
}


def output_of(*command):
    """What the command prints, or None if it fails or is missing."""
    try:
        return subprocess.run(command, capture_output=True, check=True).stdout.decode()
    except (OSError, subprocess.CalledProcessError):
        return None


def required(pattern, path):
    """Group 1 of the pattern's first match in the file."""
    with open(path, encoding="utf-8") as f:
        found = re.search(pattern, f.read(), re.M)
    if found is None:
        raise ValueError(f"{path}: nothing matches {pattern}")
    return found[1]


def licences():
    """Patterns and licences of debian/copyright, in its order."""
    with open("debian/copyright", encoding="utf-8") as f:
        stanzas = re.findall(r"^Files:((?: .*\n)+)Copyright:.*\nLicense: (.*)$", f.read(), re.M)
    return [(pattern, licence) for files, licence in stanzas for pattern in files.split()]


def licence_of(path, rules):
    """By Debian's format: that of the last pattern that matches, where * also matches slashes."""
    return [licence for pattern, licence in rules if fnmatch.fnmatchcase(path, pattern)][-1]


def identifier(kind, name):
    """An SPDX identifier, which may have only letters, digits, dots and dashes. A hash
    distinguishes names that differ in other characters."""
    plain = re.sub(r"[^A-Za-z0-9.-]", "-", name)
    return f"SPDXRef-{kind}-{plain}-{hashlib.sha256(name.encode()).hexdigest()[:8]}"


def file_entry(path, rules):
    with open(path, "rb") as f:
        data = f.read()
    return {
        "SPDXID": identifier("File", path),
        "fileName": "./" + path,
        "checksums": [
            {"algorithm": "SHA1", "checksumValue": hashlib.sha1(data).hexdigest()},
            {"algorithm": "SHA256", "checksumValue": hashlib.sha256(data).hexdigest()},
        ],
        "licenseConcluded": licence_of(path, rules),
        "licenseInfoInFiles": [NOTHING],
        "copyrightText": "2026 the TED4 authors",
    }


def dependency_entry(name, licence):
    version = output_of("dpkg-query", "-W", "-f=${Version}", name) or None
    entry = {
        "SPDXID": identifier("Package", name),
        "name": name,
        "downloadLocation": NOTHING,
        "filesAnalyzed": False,
        "licenseConcluded": NOTHING,
        "licenseDeclared": licence,
        "copyrightText": NOTHING,
        "externalRefs": [{
            "referenceCategory": "PACKAGE-MANAGER",
            "referenceType": "purl",
            "referenceLocator": f"pkg:deb/debian/{name}" +
                                (f"@{urllib.parse.quote(version)}" if version else ""),
        }],
    }
    if version:
        entry["versionInfo"] = version
    return entry


def namespace(version, code, seconds):
    """The document's namespace, by the address that SPDX 2.3, 6.5, gives to projects without a
    website."""
    unique = hashlib.sha1(f"{version} {code} {seconds}".encode()).digest()[:16]
    return f"https://spdx.org/spdxdocs/ted4-{version}-{uuid.UUID(bytes=unique, version=5)}"


def own_entry(version, files):
    """The package of the project. Its verification code is that of SPDX 2.3, 7.9."""
    sums = sorted(f["checksums"][0]["checksumValue"] for f in files)
    return {
        "SPDXID": "SPDXRef-Package-ted4",
        "name": "ted4",
        "versionInfo": version,
        "downloadLocation": NOTHING,
        "filesAnalyzed": True,
        "packageVerificationCode": {
            "packageVerificationCodeValue": hashlib.sha1("".join(sums).encode()).hexdigest()},
        "licenseConcluded": "BSD-2-Clause AND CC-BY-4.0 AND CC0-1.0",
        "licenseDeclared": "BSD-2-Clause AND CC-BY-4.0 AND CC0-1.0",
        "licenseInfoFromFiles": [NOTHING],
        "copyrightText": "2026 the TED4 authors",
    }


def relation(one, kind, other):
    return {"spdxElementId": one, "relationshipType": kind, "relatedSpdxElement": other}


def document(paths, seconds):
    rules = licences()
    names = required(r"^DEPS *= ((?:.*\\\n)*.*)$", "Makefile").replace("\\\n", " ").split()
    if sorted(names) != sorted(DEPENDENCIES):
        raise ValueError("the Makefile's DEPS are not those of DEPENDENCIES")
    version = required(r'^#define TED4_VERSION *"(.*)"$', "ref-decoder/ted4.h")
    files = [file_entry(path, rules) for path in paths]
    own = own_entry(version, files)
    code = own["packageVerificationCode"]["packageVerificationCodeValue"]
    ours = own["SPDXID"]
    created = datetime.datetime.fromtimestamp(seconds, datetime.timezone.utc)
    return {
        "spdxVersion": "SPDX-2.3",
        "dataLicense": "CC0-1.0",
        "SPDXID": "SPDXRef-DOCUMENT",
        "name": f"ted4-{version}",
        "documentNamespace": namespace(version, code, seconds),
        "creationInfo": {
            "created": created.strftime("%Y-%m-%dT%H:%M:%SZ"),
            "creators": ["Tool: ted4-sbom.py", "Organization: the TED4 authors"],
        },
        "packages": [own] + [dependency_entry(n, DEPENDENCIES[n][1]) for n in names],
        "files": files,
        "relationships": [relation("SPDXRef-DOCUMENT", "DESCRIBES", ours)]
        + [relation(identifier("Package", n), DEPENDENCIES[n][0], ours) for n in names]
        + [relation(ours, "CONTAINS", f["SPDXID"]) for f in files],
    }


def main(argv):
    if len(argv) != 2:
        print("sbom.py: usage: sbom.py FILE", file=sys.stderr)
        return 3
    listed = output_of("git", "ls-files", "-z")
    seconds = os.environ.get("SOURCE_DATE_EPOCH") or output_of("git", "log", "-1", "--format=%ct")
    if not listed or not seconds:
        print("sbom.py: this is no git repository with a commit", file=sys.stderr)
        return 3
    paths = sorted(p for p in listed.split("\0") if os.path.isfile(p) and not os.path.islink(p))
    try:
        made = document(paths, int(seconds))
        text = json.dumps(made, indent=1) + "\n"
        with open(argv[1] + ".new", "w", encoding="utf-8") as f:
            f.write(text)
        os.replace(argv[1] + ".new", argv[1])
    except (OSError, ValueError) as error:
        print(f"sbom.py: {error}", file=sys.stderr)
        return 3
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))

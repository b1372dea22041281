"""What a package of recald is made of, as SPDX 2.3 (JSON).

    make_sbom.py DEB DATABASE LOCK_FILE DEV_PACKAGE… >recald.spdx.json

Libraries that are linked are those that the package depends on. Libraries of headers, which are compiled in, are the
DEV_PACKAGEs of which no library is linked. Versions come from the dpkg DATABASE of what it was built with, those of the
pages' scripts from npm's LOCK_FILE.
"""
import datetime
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys

deb, database, lock_file = (pathlib.Path(argument) for argument in sys.argv[1:4])
dev_packages = sys.argv[4:]


def printed(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def field(name):
    return printed("dpkg-deb", "--field", deb, name).strip()


architecture, version = field("Architecture"), field("Version")
installed = {}
for line in printed("dpkg-query", "--admindir", database, "--show", "--showformat",
                    "${Package}\t${Version}\t${Architecture}\t${source:Package}\t${Depends}\t${Provides}\n").splitlines():
    name, *rest = line.split("\t")
    installed[name] = dict(zip(("version", "architecture", "source", "depends", "provides"), rest))


def names(depends):
    return [re.match(r"[a-z0-9.+-]+", part.strip())[0] for part in depends.split(",") if part.strip()]


def has_headers(name):
    lists = [database / "info" / f"{name}.list", database / "info" / f"{name}:{architecture}.list"]
    return any(re.search(r"/include/|/cmake/", one.read_text()) for one in lists if one.exists())


def with_headers(name):
    """The package itself, or those that it stands for: libboost-dev has nothing but a dependency."""
    return [name] if has_headers(name) else [
        found for other in names(installed[name]["depends"]) if other.endswith("-dev") for found in with_headers(other)]


provided_by = {other: name for name, one in installed.items() for other in names(one["provides"])} | {
    name: name for name in installed}
linked = {provided_by[name] for name in names(field("Depends")) if name in provided_by}  # systemd stands for two
sources = {installed[name]["source"] for name in linked}
compiled_in = sorted({found for name in dev_packages for found in with_headers(name)
                      if installed[found]["source"] not in sources})
scripts = {path.rpartition("node_modules/")[2]: one
           for path, one in json.loads(lock_file.read_text())["packages"].items() if path and not one.get("dev")}
assert linked and compiled_in and scripts, (linked, compiled_in, scripts)


def package(name, **facts):
    return {"SPDXID": "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", name), "name": name, "filesAnalyzed": False,
            "downloadLocation": "NOASSERTION", "licenseConcluded": "NOASSERTION", "licenseDeclared": "NOASSERTION",
            "copyrightText": "NOASSERTION", **facts}


def purl(locator):
    return [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl", "referenceLocator": locator}]


def of_debian(name):
    one = installed[name]
    where = f"pkg:deb/debian/{name.replace('+', '%2B')}@{one['version'].replace('+', '%2B').replace(':', '%3A')}"
    return package(name, versionInfo=one["version"], supplier="Organization: Debian",
                   sourceInfo=f"built from: {one['source']}", externalRefs=purl(f"{where}?arch={one['architecture']}"))


sha256 = hashlib.sha256(deb.read_bytes()).hexdigest()
recald = package("recald", versionInfo=version, packageFileName=deb.name, licenseDeclared="Apache-2.0",
                 checksums=[{"algorithm": "SHA256", "checksumValue": sha256}], primaryPackagePurpose="APPLICATION")
dynamic = [of_debian(name) for name in sorted(linked)]
static = [of_debian(name) for name in compiled_in] + [
    package(name, versionInfo=one["version"], licenseDeclared=one.get("license", "NOASSERTION"),
            externalRefs=purl(f"pkg:npm/{name}@{one['version']}")) for name, one in sorted(scripts.items())]
created = datetime.datetime.fromtimestamp(int(os.environ["SOURCE_DATE_EPOCH"]), datetime.timezone.utc)
json.dump({
    "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": deb.stem,
    "documentNamespace": f"https://spdx.org/spdxdocs/{deb.stem}-{sha256}",
    "creationInfo": {"created": created.strftime("%Y-%m-%dT%H:%M:%SZ"), "creators": ["Tool: make_sbom.py"]},
    "packages": [recald, *dynamic, *static],
    "relationships": [
        {"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES", "relatedSpdxElement": recald["SPDXID"]},
        *({"spdxElementId": recald["SPDXID"], "relationshipType": kind, "relatedSpdxElement": one["SPDXID"]}
          for kind, several in (("DEPENDS_ON", dynamic), ("CONTAINS", static)) for one in several)]},
    sys.stdout, indent=1)
print()

"""The SBOM of a package is valid SPDX 2.3 and names what the package is linked with.

    sbom.py SBOM DEB
"""
import re
import subprocess
import sys

from spdx_tools.spdx.model import RelationshipType
from spdx_tools.spdx.parser.parse_anything import parse_file
from spdx_tools.spdx.validation.document_validator import validate_full_spdx_document

sbom, deb = sys.argv[1:]
document = parse_file(sbom)
problems = validate_full_spdx_document(document)
assert not problems, "\n".join(problem.validation_message for problem in problems)
assert document.creation_info.spdx_version == "SPDX-2.3"

names = {package.spdx_id: package.name for package in document.packages}


def related(kind):
    return {names[one.related_spdx_element_id] for one in document.relationships if one.relationship_type is kind}


depends = subprocess.run(["dpkg-deb", "--field", deb, "Depends"], check=True, capture_output=True, text=True).stdout
libraries = {name for name in re.findall(r"(?:^|, )(lib[a-z0-9.+-]+)", depends.strip())}
linked = related(RelationshipType.DEPENDS_ON)
assert libraries
for library in libraries:  # a dependency may be on a name that a package provides: libspdlog1.10-fmt9
    assert any(library.startswith(name) for name in linked), f"{library} is not among {sorted(linked)}"
contained = related(RelationshipType.CONTAINS)
for wanted in ("libeigen3-dev", r"libboost[\d.]+-dev", "libcli11-dev", "libtomlplusplus-dev", "nlohmann-json3-dev",
               "libexpected-dev", "echarts", "zrender"):
    assert any(re.fullmatch(wanted, name) for name in contained), f"{wanted} is not among {sorted(contained)}"
assert all(package.version for package in document.packages), "a package without a version"
print(f"{len(document.packages)} packages")

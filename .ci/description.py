"""Fail if the description of the installed package has links that lead nowhere outside the repository."""

import re
import sys
from importlib.metadata import metadata

found = metadata("yawdesign")
text = str(found.get("Description") or found.get_payload())
if "# yawdesign" not in text:
    sys.exit("the installed package has no description")
if links := re.findall(r"\]\((?!https?://)[^)]*\)", text):
    sys.exit(f"links that lead nowhere outside the repository: {', '.join(links)}")

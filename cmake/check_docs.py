#!/usr/bin/env python3
"""Fails if a page of docs/ names a file or a member (`Class::member`) that the sources do not have, or if its table of contents
gives another number of entries than a part has.

Not read for names are the two pages that record what was, decisions and measurements, and the list of former names.
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
HISTORY = {"decisions.md", "measurements.md"}
CODE = re.compile(r"`([^`\n]+)`")
FILE = re.compile(r"^[\w/.-]+\.(?:h|cpp|py)$")
MEMBER = re.compile(r"^(?:(?:\w+)::)*(\w+)::(\w+)\b")
SHOWN_ONLY = {"uniform_sampling"}  # docs/adding-a-method.md makes it


def wrong_contents(text):
    """The parts of a page whose number of entries, in brackets in its contents, is not theirs."""
    parts = {part.split("\n")[0]: part.count("\n### ") for part in text.split("\n## ")[1:]}
    said = re.findall(r"^- \[(.+?)\]\(#.+?\) \((\d+)\)$", text, re.M)
    return [f"{name} has {parts.get(name, 0)} entries, not {number}" for name, number in said if parts.get(name) != int(number)]


def main():
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, capture_output=True, text=True, check=True)
    files = [f for f in listed.stdout.splitlines() if (ROOT / f).exists()]
    sources = [(ROOT / f).read_text() for f in files if f.startswith(("src/", "include/", "bench/")) and f.endswith((".h", ".cpp"))]
    words = [set(re.findall(r"\w+", text)) for text in sources]
    errors = []
    for page in sorted((ROOT / "docs").glob("*.md")):
        errors += [f"docs/{page.name}: {wrong}" for wrong in wrong_contents(page.read_text())]
        if page.name in HISTORY:
            continue
        for code in CODE.findall(page.read_text().split("## Former names")[0]):
            if any(name in code for name in SHOWN_ONLY):
                continue
            if FILE.match(code) and not any(("/" + f).endswith("/" + code) for f in files):
                errors.append(f"docs/{page.name}: there is no file {code}")
            member = MEMBER.match(code)
            if member and member[1] != "std" and not any(member[1] in w and member[2] in w for w in words):
                errors.append(f"docs/{page.name}: there is no {code}")
    print("\n".join(errors) if errors else "docs: fine")
    return 1 if errors else 0


sys.exit(main())

#!/usr/bin/env python3
"""Writes what docs/adding-a-method.md shows into a folder to be compiled: extract_code.py PAGE SOURCE_FOLDER OUT_FOLDER.

A block of C++ belongs to the file that the last `path` in backticks before it names. Where the project has no such file, the
block is the file. Where it has one, the block is an excerpt of it, with lines that are new:
- of the list of methods: its `#include` and its entries, of which all but the new ones must be the list's own;
- of a file of tests: a test, which joins those that are there.
"""
import pathlib
import re
import sys

BLOCK = re.compile(r"^```cpp\n(.*?)^```$", re.M | re.S)
NAMED = re.compile(r"`([\w/.]+\.(?:h|cpp))`")
ENTRY = re.compile(r"\b(\w+)_info\(\)")


def with_method(registry, excerpt):
    """The list of methods with the excerpt's include and its new entry."""
    listed, shown = ENTRY.findall(registry), ENTRY.findall(excerpt)
    new = [name for name in shown if name not in listed]
    if [name for name in shown if name in listed] != listed or len(new) != 1:
        sys.exit(f"adding-a-method.md shows another list of methods: {', '.join(shown)}; the project's: {', '.join(listed)}")
    includes = re.findall(r'^#include "[^"]+"\n', excerpt, re.M)
    after = shown[shown.index(new[0]) - 1]
    text = registry.replace(f"{after}_info()", f"{after}_info(), {new[0]}_info()", 1)
    return text.replace('#include "methods/method.h"\n', '#include "methods/method.h"\n' + "".join(includes), 1)


def with_test(tests, excerpt):
    """A file of tests with one more, at its end."""
    end = tests.rindex("}  // namespace\n}")
    return tests[:end] + excerpt + "\n" + tests[end:]


def main():
    page, root, out = (pathlib.Path(argument) for argument in sys.argv[1:4])
    text = page.read_text()
    for block in BLOCK.finditer(text):
        named = NAMED.findall(text[:block.start()])
        if not named:
            sys.exit(f"{page}: which file is this?\n{block[1]}")
        name, code = named[-1], block[1]
        own = root / name
        if own.exists():
            code = (with_method if name.endswith("registry.cpp") else with_test)(own.read_text(), code)
        target = out / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if not target.exists() or target.read_text() != code:
            target.write_text(code)


main()

#!/usr/bin/env python3
"""Every crate that is linked into the program has a licence that MIT OR Apache-2.0 can ship with.

    scripts/check_licences.py
"""

import json
import re
import subprocess
import sys

PERMISSIVE = {
    "0BSD", "Apache-2.0", "Apache-2.0 WITH LLVM-exception", "BSD-2-Clause", "BSD-3-Clause", "BSL-1.0", "CC0-1.0", "ISC",
    "MIT", "MIT-0", "Unicode-3.0", "Unlicense", "Zlib",
}


def is_permissive(expression):
    """One side of an OR will do; of an AND every part must."""
    expression = expression.replace("/", " OR ").replace("(", " ").replace(")", " ")
    choices = re.split(r"\s+OR\s+", expression.strip())
    return any(all(part.strip() in PERMISSIVE for part in re.split(r"\s+AND\s+", c)) for c in choices)


def linked_crates():
    """Names and licences of what `cargo build` links on this machine, tests left out."""
    command = ["cargo", "tree", "--edges", "normal,build", "--prefix", "none", "--format", "{p}\t{l}", "--locked"]
    lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    return sorted({tuple(line.removesuffix(" (*)").split("\t")) for line in lines})


def main():
    crates = linked_crates()
    refused = [f"{name}: {licence or 'no licence'}" for name, licence in crates if not is_permissive(licence)]
    if refused:
        sys.exit("These crates have licences that cannot be linked here:\n  " + "\n  ".join(refused))
    print(f"{len(crates)} crates are linked, all with permissive licences.")


if __name__ == "__main__":
    main()

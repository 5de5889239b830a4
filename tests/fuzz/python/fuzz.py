"""Fuzzes one reader of the Python package: fuzz.py READER [options and corpora of libFuzzer].

Anything else than a value or a ReportError is a finding; so are more than 10 s or 2 GB for one input.
"""

import sys
import warnings

import atheris

with atheris.instrument_imports(include=["thawslide", "tomllib"]):
    from readers import READERS, Folder


def main() -> None:
    """Start libFuzzer on the reader named by the first argument."""
    if len(sys.argv) < 2 or sys.argv[1] not in READERS:
        sys.exit(f"name a reader: {', '.join(READERS)}")
    warnings.simplefilter("ignore")  # of numbers that overflow
    folder = Folder(READERS[sys.argv.pop(1)])

    def test_one_input(data: bytes) -> None:
        folder.check(data)

    atheris.Setup([sys.argv[0], "-timeout=10", "-rss_limit_mb=2048", *sys.argv[1:]], test_one_input)
    atheris.Fuzz()


if __name__ == "__main__":
    main()

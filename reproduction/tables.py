"""Texts of pages: tables, marks that results replace, and wrapped paragraphs."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path

TEXTS = Path(__file__).resolve().parent / "studies" / "texts"


def markdown(lines: Sequence[Sequence[str]]) -> str:
    """Return a table, its first line the header; a line is a list of cells, or one text with " | " between cells."""
    head, *rest = (line if isinstance(line, str) else " | ".join(line) for line in lines)
    ruler = " | ".join(["---"] * (head.count(" | ") + 1))
    return "\n".join(f"| {line} |" for line in [head, ruler, *rest])


def with_marks(text: str, parts: Mapping[str, str]) -> str:
    """Return a text in which parts replace the marks @NAME@; an empty part is removed with its paragraph."""
    for name, part in parts.items():
        text = text.replace(f"@{name}@" if part else f"@{name}@\n\n", part)
    return text


def text_of(name: str, parts: Mapping[str, str]) -> str:
    """Return a text of the folder of texts, with its marks replaced."""
    return with_marks((TEXTS / name).read_text(encoding="utf-8"), parts)


def rewrapped(text: str, width: int = 120) -> str:
    """Return a document with paragraphs and list items wrapped; tables and headings are unchanged."""
    blocks = []
    for block in text.strip().split("\n\n"):
        if block.lstrip().startswith(("|", "#", "!", "```")):
            blocks.append(block.strip())
            continue
        blocks.append(
            "\n".join(
                textwrap.fill(
                    " ".join(item.split()),
                    width,
                    subsequent_indent="  " if item.startswith("- ") else "",
                    break_long_words=False,
                    break_on_hyphens=False,
                )
                for item in re.split(r"\n(?=- )", block.strip())
            )
        )
    return "\n\n".join(blocks) + "\n"

"""Writes docs/reliability.md from what scripts/reliability has found."""

from __future__ import annotations

import json
import textwrap
from pathlib import Path
from typing import Any

KINDS = {
    ("once", "io"): "that call alone (input/output error)",
    ("onwards", "full"): "that call and all after it (disk full)",
    ("onwards", "denied"): "that call and all after it (permission denied)",
    ("size", "size"): "nothing by itself, but files may be no larger than 1 to 20 kB (`ulimit -f`)",
    ("disk", "disk"): "nothing by itself, but the disk has 8 to 200 kB (tmpfs), until there is room",
    ("short", "full"): "half of what it writes arrives, nothing after it (disk full)",
}


def paragraph(text: str) -> str:
    """Return a paragraph in lines of a page."""
    return textwrap.fill(text, 118, break_on_hyphens=False, break_long_words=False) + "\n"


def head() -> str:
    """Return what the page begins with."""
    return "# Reliability\n\n" + paragraph(
        "What a run keeps when it is killed, when its disk fills up, and when its files are damaged, as tried by "
        "`scripts/reliability`, which writes this page in over an hour on two cores; a sample of each part is in "
        "`./test`. What to do when a run has stopped is in the [user guide](user-guide.md#when-a-run-stops)."
    )


def findings_text(rows: list[dict[str, Any]]) -> str:
    """Return what was not as it should be; empty: nothing."""
    findings = [finding for row in rows for finding in row["findings"]]
    if not findings:
        return ""
    lines = [f"- {finding}" for finding in findings[:20]]
    return f"\n{len(findings)} findings, of which:\n\n" + "\n".join(lines) + "\n"


def kills_text(found: dict[str, Any]) -> str:
    """Return the part on runs that were killed."""
    rows = found["rows"]
    lines = [f"| {row['subject']} | {row['seconds']:.0f} | {row['killed']} | {row['sound']} |\n" for row in rows]
    trials, sound = sum(row["trials"] for row in rows), sum(row["sound"] for row in rows)
    return (
        "## Kills\n\n"
        + paragraph(
            "Each run is killed (SIGKILL) at a random moment of its time, from its first millisecond on, and "
            "then resumed (`thawslide resume`; run again where it was killed before it had read its case). Every "
            "file must be that of the run that nothing disturbed: history, probes, maps and checkpoint byte for "
            "byte, snapshots and index in every number. Only `run.json`, which tells of processes, may differ."
        )
        + "\n| case | seconds a run | runs killed | ended with the same bits |\n|---|---|---|---|\n"
        + "".join(lines)
        + f"\n{sound} of {trials} ended with the same bits, without any repair by hand.\n"
        + findings_text(rows)
    )


def writes_text(found: dict[str, Any]) -> str:
    """Return the part on calls that fail."""
    rows = found["rows"]
    lines = [
        f"| {row['subject']} | {KINDS[(row['kind'], row['reason'])]} | {row['trials']} of {row['calls']:,} |"
        f" {row['sound']} |\n"
        for row in rows
    ]
    return (
        "## Writing that fails\n\n"
        + paragraph(
            "Each call of a run that changes its folder (open, write, truncate, synchronise, rename, make a "
            "folder) is made to fail in turn; in 3D, where maps alone are thousands, every 41st. The run must "
            "end with an error that names the file, or go on where nothing is lost by it; then, with room again, "
            "it is resumed and must end with the bits of the undisturbed run."
        )
        + "\n| case | what fails | tried | sound |\n|---|---|---|---|\n"
        + "".join(lines)
        + findings_text(rows)
    )


def corruption_text(found: dict[str, Any]) -> str:
    """Return the part on damaged checkpoints."""
    row = found["rows"][0]
    return (
        "## Damaged checkpoints\n\n"
        + paragraph(
            f"One bit of one byte is changed in both checkpoints of a run that was killed, at {row['changed']:,} "
            f"of their {row['bytes']:,} bytes. Detected and refused: {row['detected']:,}. Where only the newer "
            "one is damaged the run goes on from the other (`tests/cli/resume_test.py`)."
        )
        + findings_text(found["rows"])
    )


def mistakes_text(found: dict[str, Any]) -> str:
    """Return the part on wrong case files."""
    row = found["rows"][0]
    return (
        "## Wrong case files\n\n"
        + paragraph(
            f"{row['cases']} case files, each wrong in one thing: every parameter with a value of another type, out of "
            "its range, with a word that it does not take, and misspelt. Each must be refused with code 2, file and "
            "line, what was found and what is allowed, before anything is written. Not told so: "
            f"{len(row['findings'])}. The twenty commonest mistakes are tested word for word "
            "(`tests/cli/mistakes_test.py`)."
        )
        + findings_text(found["rows"])
    )


def soak_text(found: dict[str, Any]) -> str:
    """Return the part on a million steps."""
    row = found["rows"][0]
    same = "the same" if row["same_bits"] else "not the same"
    return (
        "## A million steps\n\n"
        + paragraph(
            f"A block of {row['particles']} particles on level ground, {row['steps']:,} steps, in two runs side "
            f"by side ({row['wall_s']:.0f} s each)."
        )
        + "\n| what | after a tenth | at the end |\n|---|---|---|\n"
        f"| memory | {row['memory_after_a_tenth_kB'] / 1024:.1f} MB | {row['memory_at_the_end_kB'] / 1024:.1f} MB |\n"
        f"| strain energy | {row['strain_after_a_tenth_J']:.6g} J | {row['strain_at_the_end_J']:.6g} J |\n\n"
        + paragraph(
            f"Kinetic energy: {row['largest_kinetic_J']:.3g} J at most, {row['kinetic_at_the_end_J']:.3g} J at "
            f"the end; residual of the mechanical account: {row['residual_J']:.3g} J at most. History and "
            f"checkpoint of the two runs are {same} bit for bit."
        )
    )


TEXTS = {
    "kills": kills_text,
    "writes": writes_text,
    "corruption": corruption_text,
    "mistakes": mistakes_text,
    "soak": soak_text,
}


def write_page(results: Path, page: Path) -> None:
    """Write the page; a part that never ran says so."""
    parts = [head()]
    for name, text in TEXTS.items():
        file = results / f"{name}.json"
        found = json.loads(file.read_text()) if file.exists() else None
        made = f"\n*{found['version']}, {found['wall_s'] / 60:.0f} minutes.*\n" if found else ""
        parts.append(text(found) + made if found else f"## {name.capitalize()}\n\nThis part has not been run.\n")
    page.write_text("\n".join(parts))

"""The words and the sentence lengths of pages, messages and labels are within their limits."""

import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))

import prose_texts as prose  # noqa: E402

RULES = prose.read_rules(ROOT / "scripts" / "prose_rules.toml")


def hits_in(page: str) -> list[tuple[int, str, str]]:
    """Return line, words and advice of the counted hits in a page."""
    found = prose.findings(prose.texts_of_page("a.md", page), RULES)
    return [(hit.line, hit.found, hit.advice) for hit in found.hits if hit.counted]


def lengths_in(page: str, max_words: int = 0) -> list[int]:
    """Return the lengths of the sentences that have more words than a limit."""
    rules = prose.Rules(RULES.patterns, RULES.occurrences, max_words, RULES.word, RULES.abbreviations)
    return [sentence.words for sentence in prose.findings(prose.texts_of_page("a.md", page), rules).long]


def check(*words: str | Path) -> subprocess.CompletedProcess[str]:
    script = ROOT / "scripts" / "prose-check"
    return subprocess.run([script, *words], capture_output=True, text=True, timeout=600, check=False)


def test_counts_are_within_their_limits() -> None:
    checked = check("--limits")
    assert checked.returncode == 0, checked.stdout + checked.stderr


def test_an_unused_justification_and_an_unknown_file_are_refused(tmp_path: Path) -> None:
    limits = tmp_path / "limits.toml"
    entry = '[[justified]]\nfile = "README.md"\nrule = "term"\nphrase = "no such phrase"\nreason = "none"\n'
    limits.write_text((ROOT / "scripts" / "prose_limits.toml").read_text() + entry)
    unused, unknown = check("--limits", limits), check("NONE.md")
    assert unused.returncode == 1
    assert unused.stdout == "README.md: no hit for the justified phrase: no such phrase\n"
    assert unknown.returncode == 2 and "no prose in NONE.md" in unknown.stderr


def test_terms_are_found_with_line_and_replacement_outside_code() -> None:
    assert hits_in("A run\nuses the\ncard now.\n") == [(3, "card", "GPU")]
    assert hits_in("The largest speed.") == [(1, "largest speed", "maximum speed")]
    assert hits_in("It ends amid\na run.") == [(1, "amid", "during")]
    assert hits_in("The run goes\non.") == [(1, "goes on", "continue|resume")]
    page = "A `card` or ``a ` card``\n\n```\nthe card\n```\n\n[text](card.md) https://a.org/card\n\n<!-- a\ncard -->\n"
    assert hits_in(page) == []
    assert hits_in(page + "\nA card.\n") == [(12, "card", "GPU")]
    page = "# The card\n\n| card | `card` |\n|---|---|\n| `a|card` | a card |\n\n- one\n- card\n\n> a card\n"
    assert [line for line, _, _ in hits_in(page)] == [1, 3, 5, 8, 10]


def test_a_free_relative_opens_a_sentence_and_tokens_are_words() -> None:
    for text, found in (
        ("It runs. What it notes is valid.", ["What it"]),
        ("- Where a body rests.\n", ["Where a"]),
        ("What is the runout? It shows what it notes.", []),
        ("# What to try\n", []),
        ("The nodes feel it, where the case gives it.", ["where the case gives", "nodes feel"]),
        ("The nodes feeling it, somewhere the case gives it.", []),
    ):
        assert [words for _, words, _ in hits_in(text)] == found


def test_uncounted_words_joints_and_long_paragraphs_are_reported() -> None:
    found = prose.findings(prose.texts_of_page("a.md", "A share, so that it stays where it is."), RULES)
    assert {hit.rule for hit in found.hits} == {"share", "so that", "where"}
    assert not any(hit.counted for hit in found.hits)
    page = "One: two; three. Four: five.\n\n" + "Word word. " * 56 + "\n\n" + "Word word. " * 55
    found = prose.findings(prose.texts_of_page("a.md", page), RULES)
    assert [(hit.line, hit.rule, hit.counted) for hit in found.hits] == [(1, "joints", False), (3, "paragraph", False)]


def test_words_of_a_sentence_are_counted_and_limited() -> None:
    assert lengths_in("One two three. Four *five*\n`six seven` eight.\n") == [3, 4]
    assert lengths_in("A band-like layer of 1,220.5 m at [a link](b.md).") == [9]
    assert lengths_in("By e.g. Rice et al. (2006) in Eq. 4. Next one.") == [9, 2]
    assert lengths_in("- one two\n- three\n\n| four | five six |\n|---|---|\n") == [2, 1, 1, 2]
    assert RULES.max_words == 28
    assert lengths_in("word " * 28 + ".", RULES.max_words) == []
    assert lengths_in("word " * 29 + ".", RULES.max_words) == [29]


def test_messages_and_labels_are_strings_of_several_words() -> None:
    comment = "// the card has one and more\n/* 'a card' of \"two or three\" */\n"
    source = comment + 'f("card", "the run uses "\n  "a card at {}", x); g(R"(one\na card and two more)");\n'
    texts = prose.texts_of_cpp("a.cpp", source, RULES)
    assert [text.chars for text in texts] == [f"the run uses a card at {prose.CODE}", "a card and two more"]
    assert [(hit.line, hit.found) for hit in prose.findings(texts, RULES).hits] == [(4, "card"), (5, "card")]
    source = (
        '"""A card."""\n\n\ndef f():\n    """A card."""\n    return f"{x} of a card" + "card" + "one card"  # card\n'
    )
    texts = prose.texts_of_python("a.py", source, RULES)
    assert [text.chars for text in texts] == [f"{prose.CODE} of a card", "one card"]
    assert [hit.line for hit in prose.findings(texts, RULES).hits] == [6, 6]


def test_a_justified_phrase_names_its_reason() -> None:
    texts = prose.texts_of_page("a.md", "A memory card. A card.")
    entry = {"file": "a.md", "rule": "term", "phrase": "memory card", "reason": "a storage medium"}
    found = prose.findings(texts, RULES, [entry, entry | {"file": "b.md"}])
    assert [hit.reason for hit in found.hits] == ["a storage medium", ""]
    assert found.unused == [entry | {"file": "b.md"}]


def test_limits_only_fall() -> None:
    counts = {"a.md": {"hits": 2, "long": 1}, "src/app": {"hits": 0, "long": 3}}
    assert prose.risen(counts, {"a.md": {"hits": 2, "long": 1}, "src/app": {"hits": 9, "long": 3}}) == []
    assert prose.risen(counts, {"a.md": {"hits": 1, "long": 1}}) == [
        "a.md: 2 hits (allowed 1)",
        "src/app: 3 long sentences (allowed 0)",
    ]
    limits = {"a.md": {"hits": 1, "long": 4}, "b.md": {"hits": 1, "long": 0}, "src/app": {"hits": 0, "long": 9}}
    fallen = prose.lowered(counts, limits)
    assert fallen == {"a.md": {"hits": 1, "long": 1}, "src/app": {"hits": 0, "long": 3}}
    assert tomllib.loads(prose.limits_text(fallen)) == fallen


def test_every_page_and_every_folder_of_code_is_read() -> None:
    groups = {prose.group_of(text.file) for text in prose.all_texts(ROOT, RULES)}
    assert {"README.md", "docs/theory/heat.md", "cases/lamplugh/assumptions.md", "src/app", "src/config"} <= groups
    assert {"benchmarks/trials.md", "python/thawslide/figures"} <= groups

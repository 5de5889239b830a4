"""Prose of pages, messages and labels, and its hits by the rules of scripts/prose_rules.toml."""

import ast
import re
import tomllib
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

CODE = "\N{CURRENCY SIGN}"  # replaces a code span or a value: counts as one word and matches no rule
MESSAGE_WORDS = 4  # fewest words of a message of C++
LABEL_WORDS = 2  # fewest words of a label of Python


@dataclass(frozen=True)
class Text:
    """A paragraph, list item, heading, table cell, message or label, in one line."""

    file: str
    chars: str
    lines: tuple[int, ...]  # line of each character

    def replaced(self, pattern, by):
        """Return the text with each match of a pattern replaced by a string."""
        chars, lines, end = [], [], 0
        for match in re.finditer(pattern, self.chars):
            begin = match.start()
            chars += [self.chars[end:begin], by]
            lines += [*self.lines[end:begin], *[self.lines[begin]] * len(by)]
            end = match.end()
        return Text(self.file, "".join(chars) + self.chars[end:], (*lines, *self.lines[end:]))


@dataclass(frozen=True)
class Hit:
    """A match of a rule."""

    file: str
    line: int
    rule: str
    found: str
    advice: str
    counted: bool
    reason: str = ""  # why it is justified


@dataclass(frozen=True)
class LongSentence:
    """A sentence with more words than allowed."""

    file: str
    line: int
    words: int
    text: str


@dataclass(frozen=True)
class Pattern:
    """An expression of a rule with its advice."""

    rule: str
    expression: re.Pattern
    advice: str
    counted: bool

    def advice_for(self, match):
        """Return the advice for a match, with its first group inserted."""
        return self.advice.replace("$1", match.group(1)) if "$1" in self.advice else self.advice


@dataclass(frozen=True)
class Occurrence:
    """A rule on the number of matches in a sentence or a paragraph."""

    rule: str
    token: re.Pattern
    most: int
    scope: str
    advice: str
    counted: bool


@dataclass(frozen=True)
class Rules:
    """All rules."""

    patterns: list[Pattern]
    occurrences: list[Occurrence]
    max_words: int
    word: re.Pattern
    abbreviations: tuple[str, ...]


@dataclass
class Findings:
    """Hits and long sentences of a set of texts."""

    hits: list[Hit] = field(default_factory=list)
    long: list[LongSentence] = field(default_factory=list)
    unused: list[dict] = field(default_factory=list)  # justifications without a hit


def read_rules(path):
    """Return the rules of a file."""
    table = tomllib.loads(Path(path).read_text(encoding="utf-8"))
    patterns, occurrences = [], []
    for rule in table["rule"]:
        if "token" in rule:
            token = re.compile(rule["token"])
            occurrences.append(
                Occurrence(rule["name"], token, rule["max"], rule["scope"], rule["advice"], rule["counted"])
            )
            continue
        flags = re.IGNORECASE if rule["ignore_case"] else re.NOFLAG
        whole_words = [rf"\b(?:{token})\b" for token in rule.get("tokens", [])]
        alike = [[expression, rule["advice"]] for expression in [*rule.get("raw", []), *whole_words]]
        for expression, advice in [*rule.get("replace", []), *alike]:
            patterns.append(Pattern(rule["name"], re.compile(expression, flags), advice, rule["counted"]))
    return Rules(patterns, occurrences, table["max_words"], re.compile(table["word"]), tuple(table["abbreviations"]))


def _joined(file, pieces):
    """Return a text of pieces (line, string) with single spaces, without code, marks and addresses."""
    chars, lines = "", []
    for line, piece in pieces:
        piece = ("" if not chars else " ") + piece.strip()
        chars += piece
        lines += [line] * len(piece)
    text = Text(file, chars, tuple(lines))
    text = text.replaced(r"(`+).+?\1", CODE).replaced(r"\\?\$[^$]+\$", CODE)
    text = text.replaced(r"\]\([^)\s]*\)", "").replaced(r"<?https?://[^\s>)]+>?", CODE)
    return text.replaced(r"!?\[(?=\S)", "").replaced(r"\*+|(?<!\w)_+(?=\w)|(?<=\w)_+(?!\w)", "").replaced(r"\s+", " ")


def _without_blocks(lines):
    """Yield the number and the string of each line; empty in code blocks, displayed formulas and comments."""
    fence, formula, comment = "", False, False
    for number, line in enumerate(lines, 1):
        opening = re.match(r"\s*(```+|~~~+)", line)
        if fence or opening:
            if not fence:
                fence = opening.group(1)
            elif opening and opening.group(1).startswith(fence):
                fence = ""
            yield number, ""
        elif formula or line.strip().startswith("$$"):
            formula ^= line.count("$$") % 2 == 1
            yield number, ""
        elif comment or line.lstrip().startswith("<!--"):
            comment = "-->" not in line
            yield number, ""
        else:
            yield number, line


def texts_of_page(file, content):
    """Return the texts of a Markdown page."""
    texts, pieces = [], []

    def close():
        if pieces:
            texts.append(_joined(file, pieces))
            pieces.clear()

    for number, line in _without_blocks(content.splitlines()):
        line = re.sub(r"^(\s*)>\s?", r"\1", line)
        if not line.strip() or re.fullmatch(r"\s*([-*_]\s*){3,}", line):
            close()
        elif line.lstrip().startswith("|"):
            close()
            masked = re.sub(r"`[^`]*`", "`x`", line).replace(r"\|", "/").strip().strip("|")
            cells = re.split(r"\||<br>", masked)
            texts += [_joined(file, [(number, cell)]) for cell in cells if re.search(r"\w", cell)]
        elif heading := re.match(r"#+\s+(.*)", line):
            close()
            texts.append(_joined(file, [(number, heading.group(1))]))
        else:
            item = re.match(r"\s*(?:[-*+]|\d+[.)])\s+(.*)", line)
            if item:
                close()
            pieces.append((number, item.group(1) if item else line))
    close()
    return texts


_TOKENS = re.compile(
    r'//[^\n]*|/\*.*?\*/|#\s*include[^\n]*|(?:u8|[uUL])?R"(?P<mark>[^(\s]*)\((?P<raw>.*?)\)(?P=mark)"'
    r"|\"(?P<plain>(?:\\.|[^\"\\\n])*)\"|(?<!\w)'(?:\\.|[^'\\\n])+'|(?P<space>\s+)|.",
    re.DOTALL,
)


def _lines_of_string(file, pieces, fewest, rules):
    """Return a text for each line of a string that has enough words."""
    rows = [[]]
    for line, piece in pieces:
        parts = piece.split("\n")
        rows[-1].append((line, parts[0]))
        rows += [[(line, part)] for part in parts[1:]]
    found = []
    for row in rows:
        chars = "".join(piece for _, piece in row)
        lines = [line for line, piece in row for _ in piece]
        text = Text(file, chars, tuple(lines)).replaced(r"`[^`]*`", CODE).replaced(r"\{[^{}]*\}", CODE)
        if len(rules.word.findall(text.chars)) >= fewest:
            found.append(text.replaced(r"\s+", " "))
    return found


def texts_of_cpp(file, content, rules):
    """Return the messages of a C++ file: its string literals, joined where they adjoin."""
    texts, pieces = [], []
    escapes = {r"\n": "\n", r"\"": '"', r"\\": "\\", r"\t": " "}
    for token in _TOKENS.finditer(content):
        literal = token["raw"] if token["raw"] is not None else token["plain"]
        if literal is not None:
            line = content.count("\n", 0, token.start()) + 1
            if token["plain"] is not None:
                pieces.append((line, re.sub(r"\\.", lambda escape: escapes.get(escape.group(), " "), literal)))
            else:
                pieces += enumerate(literal.splitlines(keepends=True), line)
        elif pieces and token["space"] is None and not token.group().startswith(("//", "/*")):
            texts += _lines_of_string(file, pieces, MESSAGE_WORDS, rules)
            pieces = []
    return texts + (_lines_of_string(file, pieces, MESSAGE_WORDS, rules) if pieces else [])


def texts_of_python(file, content, rules):
    """Return the labels and messages of a Python file: its strings without those that document."""
    texts, skipped = [], set()
    nodes = [node for node in ast.walk(ast.parse(content)) if hasattr(node, "lineno")]
    for node in sorted(nodes, key=lambda node: (node.lineno, node.col_offset)):  # a node before its parts
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            skipped.add(id(node.value))
        if id(node) in skipped:
            continue
        if isinstance(node, ast.JoinedStr):
            skipped |= {id(part) for part in node.values if isinstance(part, ast.Constant)}
            skipped |= {id(part.format_spec) for part in node.values if isinstance(part, ast.FormattedValue)}
            pieces = [(p.lineno, p.value if isinstance(p, ast.Constant) else CODE) for p in node.values]
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            pieces = [(node.lineno, node.value)]
        else:
            continue
        texts += _lines_of_string(file, pieces, LABEL_WORDS, rules)
    return texts


def all_texts(root, rules, only=()):
    """Return the texts of the repository, or those of some of its files."""
    root = Path(root)
    folders = ("docs", "cases", "benchmarks")
    pages = {*root.glob("*.md"), *(path for folder in folders for path in (root / folder).rglob("*.md"))}
    pages |= {path for form in ("scripts/*.md", "src/*/*.md", "tests/*/*.md") for path in root.glob(form)}
    sources = {*(root / "src").rglob("*.[ch]pp")}
    sources |= {
        path for folder in ("python/thawslide", "qgis", "reproduction") for path in (root / folder).rglob("*.py")
    }
    texts = []
    for path in sorted(pages | sources):
        file = path.relative_to(root).as_posix()
        if only and file not in only:
            continue
        content = path.read_text(encoding="utf-8")
        if path.suffix == ".md":
            texts += texts_of_page(file, content)
        else:
            texts += (texts_of_python if path.suffix == ".py" else texts_of_cpp)(file, content, rules)
    return texts


def sentences(text, rules):
    """Yield begin and end of each sentence of a text."""
    begin = 0
    for match in re.finditer(r"[.!?][\"')\]]*\s+(?=[\"'(\[]*[A-Z0-9" + CODE + "])", text.chars):
        before = text.chars[begin : match.start()]
        abbreviated = any(re.search(r"(?<!\w)" + re.escape(word) + "$", before) for word in rules.abbreviations)
        if not (abbreviated and match.group()[0] == "."):
            yield begin, match.end()
            begin = match.end()
    yield begin, len(text.chars)


def words_in(chars, rules):
    """Return the number of words; a code span, a number and a compound count as one."""
    return len(rules.word.findall(re.sub(r"(?<=\w)[-.,'/](?=\w)", "", chars))) + len(re.findall(CODE + "+", chars))


def _line_at(text, position):
    """Return the line of a position in a text."""
    return text.lines[min(position, len(text.lines) - 1)]


def _reason(text, span, rule, justified, used):
    """Return the reason of the justification whose phrase contains the span."""
    for index, entry in enumerate(justified):
        if entry["file"] != text.file or entry["rule"] != rule:
            continue
        for match in re.finditer(re.escape(entry["phrase"]), text.chars):
            if match.start() <= span[0] and span[1] <= match.end():
                used.add(index)
                return entry["reason"]
    return ""


def findings(texts, rules, justified=()):
    """Return the hits and the long sentences in texts."""
    found, used = Findings(), set()
    for text in texts:
        for pattern in rules.patterns:
            for match in pattern.expression.finditer(text.chars):
                reason = _reason(text, match.span(), pattern.rule, justified, used)
                begin = match.end() - len(match.group().lstrip(".!? "))
                words = text.chars[begin : match.end()] + re.match(r"\w*", text.chars[match.end() :]).group()
                hit = (text.file, _line_at(text, begin), pattern.rule, words)
                found.hits.append(Hit(*hit, pattern.advice_for(match), pattern.counted, reason))
        spans = {"paragraph": [(0, len(text.chars))], "sentence": list(sentences(text, rules))}
        for rule in rules.occurrences:
            for begin, end in spans[rule.scope]:
                number = len(rule.token.findall(text.chars[begin:end]))
                if number > rule.most:
                    hit = (
                        text.file,
                        _line_at(text, begin),
                        rule.rule,
                        f"{number} in '{text.chars[begin:end][:40]}...'",
                    )
                    found.hits.append(Hit(*hit, rule.advice, rule.counted))
        for begin, end in spans["sentence"]:
            number = words_in(text.chars[begin:end], rules)
            if number > rules.max_words:
                long = LongSentence(text.file, _line_at(text, begin), number, text.chars[begin:end].strip())
                found.long.append(long)
    found.unused = [entry for index, entry in enumerate(justified) if index not in used]
    return found


def group_of(file):
    """Return the entry of the limits to which a file belongs: itself for a page, its folder for code."""
    return file if file.endswith(".md") else str(Path(file).parent)


def counts_of(found):
    """Return hits and long sentences of each group."""
    hits = Counter(group_of(hit.file) for hit in found.hits if hit.counted)
    long = Counter(group_of(sentence.file) for sentence in found.long)
    return {group: {"hits": hits[group], "long": long[group]} for group in sorted(hits.keys() | long.keys())}


def risen(counts, limits):
    """Return a message for each count above its limit; a group without limits has zeros."""
    names = {"hits": "hits", "long": "long sentences"}
    return [
        f"{group}: {count[kind]} {name} (allowed {limits.get(group, {}).get(kind, 0)})"
        for group, count in counts.items()
        for kind, name in names.items()
        if count[kind] > limits.get(group, {}).get(kind, 0)
    ]


def lowered(counts, limits):
    """Return limits that are nowhere above the counts."""
    least = {
        group: {kind: min(limit[kind], counts.get(group, {}).get(kind, 0)) for kind in ("hits", "long")}
        for group, limit in limits.items()
    }
    return {group: limit for group, limit in sorted(least.items()) if any(limit.values())}


def limits_text(limits):
    """Return limits as lines of TOML."""
    return "".join(f'"{group}" = {{ hits = {n["hits"]}, long = {n["long"]} }}\n' for group, n in limits.items())

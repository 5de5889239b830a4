"""Hooks of mkdocs for pages at their paths in the repository: files, notebooks, lists as on GitHub, formulas.

mkdocs.yml names this file. The site has the folders of the repository, and the same relative links work in both,
except those to generated pages.
"""

import html
import json
import re
import subprocess
import unicodedata
from pathlib import Path

import ziamath
from latex2mathml.converter import convert
from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File, Files

ROOT = Path(__file__).resolve().parent.parent
PAGES = re.compile(r"[^/]+\.md|docs/.+\.md|cases/[^/]+/[^/]+\.md")
GENERATED = ROOT / "build" / "site" / "pages"  # by scripts/site
NOTEBOOKS = "docs/notebooks/*.ipynb"
NOTEBOOK_LINK = re.compile(r"(\]\([^)\s]+)\.ipynb(?=[)#])")
LINK = re.compile(r"\]\(([^)\s#]+)")
FENCED = re.compile(r"^ *```.*?^ *```", re.MULTILINE | re.DOTALL)
ASSETS = {
    "assets/site.css": ROOT / "scripts" / "site.css",
    "assets/iframe-worker.js": ROOT / "scripts" / "site_worker.js",
    "assets/mathematics.ttf": Path(ziamath.__file__).parent / "fonts" / "STIXTwoMath-Regular.ttf",
}

ITEM = re.compile(r"( *)([-*+]|\d+[.)]) +")
FORMULA = re.compile(r'<(span|div) class="arithmatex">\\[(\[](.*?)\\[)\]]</\1>', re.DOTALL)
TAG = re.compile(r"\\tag\{([^}]*)\}")
CAPITAL = re.compile(r"<mi>(&#x0039[1-9A-F];|&#x003A[0-9];)</mi>")
FUNCTION = re.compile(r"<mi>([a-z]{2,})</mi>(?!<mo[^>]*>&#x00028;)")
VARIANT = re.compile(r'<(mi|mn) mathvariant="(bold|bold-italic|script|double-struck)">(.*?)</\1>')


def files_of_site():
    """Return the path in the site of each page and each file to which a page links, and the file itself."""
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    known = {path for path in listed.splitlines() if (ROOT / path).is_file()}
    pages = {path: ROOT / path for path in known if PAGES.fullmatch(path)}
    pages |= {str(path.relative_to(GENERATED)): path for path in GENERATED.rglob("*.md")}
    linked = set()
    for page, file in pages.items():
        for target in LINK.findall(FENCED.sub("", file.read_text(encoding="utf-8"))):
            path = (ROOT / page).parent.joinpath(target).resolve()
            if path.is_relative_to(ROOT):
                linked.add(str(path.relative_to(ROOT)))
    return {path: ROOT / path for path in linked & known} | pages


def markdown_of(notebook):
    """Return a notebook as a page: its texts, its code, and the outputs stored in it."""
    parts = []
    for cell in json.loads(notebook.read_text(encoding="utf-8"))["cells"]:
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(source)
            continue
        parts.append(f"```python\n{source}\n```")
        for output in cell["outputs"]:
            data = output.get("data", {"text/plain": output.get("text", "")})
            if "image/png" in data:
                parts.append(f"![Output](data:image/png;base64,{''.join(data['image/png']).strip()})")
            else:
                parts.append(f"```text\n{''.join(data['text/plain']).rstrip()}\n```")
    return "\n\n".join(parts) + "\n"


def on_files(files, config):
    """Replace the files of docs_dir by those of the repository, and notebooks by pages."""
    theme = [file for file in files if file.src_dir != config.docs_dir]
    own = {path: file for path, file in files_of_site().items() if not path.endswith(".ipynb")} | ASSETS
    pages = {str(path.relative_to(ROOT).with_suffix(".md")): markdown_of(path) for path in ROOT.glob(NOTEBOOKS)}
    return Files(
        theme
        + [File.generated(config, path, abs_src_path=str(file)) for path, file in own.items()]
        + [File.generated(config, path, content=text) for path, text in pages.items()]
    )


def on_page_markdown(markdown, **_):
    """Indent the contents of list items by four columns per level, as Python-Markdown requires; link to pages.

    "[x, y] [m]" in a table is no reference.
    """
    markdown = NOTEBOOK_LINK.sub(r"\1.md", markdown)
    markdown = re.sub(r"^\|.*", lambda row: row[0].replace("] [", "] \\["), markdown, flags=re.MULTILINE)
    depths = []  # columns at which the text of the open items begins
    fence = False
    lines = []
    for line in markdown.splitlines():
        indent = len(line) - len(line.lstrip(" "))
        item = None if fence else ITEM.match(line)
        if line.strip() and not fence:
            while depths and indent < depths[-1] and (item or not lines[-1].strip()):
                depths.pop()
        moved = min(indent, depths[-1]) if depths else 0
        lines.append(" " * 4 * len(depths) + line[moved:] if line.strip() else "")
        if item:
            depths.append(item.end())
        if line.lstrip().startswith("```"):
            fence = not fence
    return "\n".join(lines) + "\n"


def styled(match):
    """Return an element with a character of the variant, because browsers ignore the attribute."""
    name, variant, text = match.groups()
    letter = html.unescape(text)
    described = unicodedata.name(letter).replace(" LETTER", "").removeprefix("LATIN ").removeprefix("GREEK ")
    style = "" if "DIGIT" in described and variant != "bold" else variant.upper().replace("-", " ")
    for name_of_letter in (f"MATHEMATICAL {style} {described}", f"{style} {described}"):
        try:
            return f"<{name}>{unicodedata.lookup(name_of_letter)}</{name}>"
        except KeyError:
            continue
    raise PluginError(f"no {variant} form of {letter} exists")


def formula(match):
    """Return a formula in MathML, followed by its number."""
    kind, latex = match[1], html.unescape(match[2])
    tag = TAG.search(latex)
    latex = TAG.sub("", latex).replace("{aligned}", "{split}").strip()
    latex = re.sub(r"\\mathrm\s*(?:\{(\w)\}|(\w)\b)", r"\\text{\1\2}", latex)
    drawn = convert(latex, display="block" if kind == "div" else "inline")
    if "\\" in drawn or "&</mi>" in drawn:
        raise PluginError(f"latex2mathml cannot convert this formula: {latex}")
    drawn = VARIANT.sub(styled, drawn)
    drawn = CAPITAL.sub(r'<mi mathvariant="normal">\1</mi>', drawn)  # upright, as in LaTeX
    drawn = FUNCTION.sub(r'<mo lspace="0.17em" rspace="0.17em">\1</mo>', drawn)
    if kind == "span":
        return drawn
    number = f"<span>({tag[1]})</span>" if tag else ""
    return f'<div class="formula"><div>{drawn}</div>{number}</div>'


def on_page_content(content, page, **_):
    """Convert the formulas of a page."""
    try:
        return FORMULA.sub(formula, content)
    except PluginError as error:
        raise PluginError(f"{page.file.src_uri}: {error}") from error

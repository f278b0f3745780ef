"""Displayed formulas of a page, which are indented text in the repository, as KaTeX for the site; symbols within sentences as letters with indices and powers.

Columns of a line stand three or more spaces apart. A column with at most two words is a formula; others stay text. `<x - y>` with no
space inside its ends are Macaulay's brackets, ` . ` and ` x ` between two factors are products.
"""
import html
import re

LETTERS = dict(zip("alpha beta gamma delta epsilon zeta eta theta kappa lambda mu nu xi pi rho sigma tau phi psi omega Delta Phi Psi Omega".split(),
                   "αβγδεζηθκλμνξπρστφψωΔΦΨΩ"))
FUNCTIONS = {"sin": r"\sin", "cos": r"\cos", "tan": r"\tan", "exp": r"\exp", "ln": r"\ln", "min": r"\min", "max": r"\max", "det": r"\det"}
NAMED = {name: rf"\operatorname{{{name}}}" for name in ("tr", "sym", "cof", "sgn")} | FUNCTIONS | {"sum": r"\sum", "int": r"\int"}
TOKEN = re.compile(r"`[^`]*`|[A-Za-z]+\d?(?:_[A-Za-z0-9]+)?'*|\d+(?:\.\d+)?(?:e-?\d+)?|<=|>=|<-|->|-=|\+=|\.\.\.|\s+|.")
SIGNS = {"<=": r"\le ", ">=": r"\ge ", "<-": r"\leftarrow ", "->": r"\to ", "-=": r"\mathrel{-}=", "+=": r"\mathrel{+}=", "...": r"\ldots ", "{": r"\{", "}": r"\}",
         "%": r"\%", "#": r"\#", "&": r"\&", "$": r"\$", "~": r"\sim ", "*": r"\cdot "}


def escaped(text):
    """For \\text{...}."""
    return re.sub(r"([_#%&${}])", r"\\\1", text.replace("\\", "").replace("~", " ")).replace("^", r"\textasciicircum{}")


def symbol(word):
    """A quantity; None if the word is no symbol."""
    name, _, below = word.rstrip("'").partition("_")
    primes = "'" * (len(word) - len(word.rstrip("'")))
    if name in NAMED:
        base = NAMED[name]
    elif name in LETTERS:
        base = rf"\{name}"
    elif len(name) == 1 or re.fullmatch(r"[A-Z]\d", name):
        base = name
    elif name[0] == "d" and (len(name) == 2 or name[1:] in LETTERS):
        base = r"\mathrm{d}" + symbol(name[1:])
    else:
        return None
    below = rf"\{below}" if below in LETTERS else below
    return base + primes + (f"_{{{below}}}" if below else "") + " "


def group(tokens, at):
    """The place behind the bracket that closes the one at `at`; None if none does."""
    depth = 0
    for k in range(at, len(tokens)):
        depth += (tokens[k] == "(") - (tokens[k] == ")")
        if depth == 0:
            return k + 1
    return None


def formula(tokens):
    out, k = [], 0
    operand = False  # what stands before is a factor
    while k < len(tokens):
        token = tokens[k]
        after = tokens[k + 1] if k + 1 < len(tokens) else " "
        before = tokens[k - 1] if k else " "
        if token.isspace():
            out.append(r"\quad " if len(token) > 1 else " ")
            k += 1
            continue
        if token == "^" and out and "'" in out[-1]:  # a prime is a power, too, and a second one needs braces
            out[-1] = "{" + out[-1].strip() + "}"
        if token in ("sqrt", "^") and after == "(" and group(tokens, k + 1):
            end = group(tokens, k + 1)
            inner = formula(tokens[k + 2:end - 1])
            out.append((r"\sqrt" if token == "sqrt" else "^") + "{" + inner + "}")
            k, operand = end, True
            continue
        if token == "^":
            power = after + (tokens[k + 2] if after == "-" and k + 2 < len(tokens) else "")
            power = symbol(power) or power
            out.append(f"^{{{power}}}")
            k += 2 if after != "-" else 3
            continue
        if token.startswith("`"):
            out.append(rf"\texttt{{{escaped(token.strip('`'))}}}")
        elif token == "x" and operand and before.isspace() and after.isspace() and k + 2 < len(tokens) and re.match(r"[A-Za-z(]", tokens[k + 2]):
            out.append(r"\times ")
            operand = False
            k += 1
            continue
        elif token == "." and (before.isspace() and after.isspace() or operand and re.match(r"[A-Za-z(]", after)):
            out.append(r"\cdot ")
            operand = False
            k += 1
            continue
        elif token == "<" and not after.isspace():
            out.append(r"\langle ")
        elif token == ">" and not before.isspace():
            out.append(r"\rangle ")
        elif re.match(r"[A-Za-z]", token):
            out.append(symbol(token) or rf"\text{{ {escaped(token)} }}")
        else:
            out.append(SIGNS.get(token, token))
        operand = bool(re.match(r"[A-Za-z0-9)\]|>`]", token)) and token not in NAMED
        k += 1
    return "".join(out)


def is_formula(text):
    tokens = [t for t in TOKEN.findall(text) if not t.isspace()]
    words = [t for t in tokens if re.match(r"[A-Za-z]", t) and t != "sqrt" and symbol(t) is None]
    return len(words) <= 2 and len(words) < len(tokens) and not (words and not re.search(r"[=<>+/^]", text))


def column(text):
    """A column of a line, as LaTeX, and whether it has a formula. Text and formulas may follow each other in it."""
    if is_formula(text):
        return formula(TOKEN.findall(text)), True
    parts, found = [], False
    for part in re.split(r"( {2,}|[,;:] |`[^`]*`)", text):
        if part.startswith("`"):
            parts.append(rf"\texttt{{{escaped(part.strip('`'))}}}")
        elif part.strip() and is_formula(part):
            parts.append(formula(TOKEN.findall(part)))
            found = found or "=" in part
        elif part:
            parts.append(rf"\text{{{escaped(part)}}}")
    return "".join(parts), found


def block(lines):
    rows, found = [], False
    for line in lines:
        line = line[4:]
        lead = ["" if line.startswith("  ") else None]  # goes on below the first column
        cells = [column(c) for c in re.split(r" {3,}", line.strip())]
        found = found or any(is_found for _, is_found in cells)
        rows.append(" & ".join([c for c in lead if c is not None] + [c for c, _ in cells]))
    if not found:
        return lines
    columns = max(row.count("&") for row in rows) + 1
    text = r"\[\begin{array}{" + "l" * columns + "}\n" + " \\\\\n".join(rows) + "\n" + r"\end{array}\]"
    return ['<div class="equation">', *html.escape(text, quote=False).split("\n"), "</div>"]


ASIDE = re.compile(r"(`[^`]*`|\]\([^)]*\)|<[^<>\s][^<>]*>|\w+://\S+)")  # code, targets of links, tags, addresses
SYMBOL = re.compile(rf"(?<![\w.])(?<![a-z]{{2}}/)({'|'.join(LETTERS)}|[A-Za-z](?=_))(?:_([A-Za-z0-9]+))?(?![\w-]*_|[A-Za-z0-9]|\.[a-z]{{2}})")
POWER = re.compile(r"(?<=[\w)>])\^(?:\(([^()]+)\)|(-?\w+|<i>\w+</i>))")


def sentence(line):
    """A line of text with its symbols: `f_t`, `rho_s^2` and `**x**_b` as letters with indices and powers; code and links stay."""
    parts = ASIDE.split(line)
    for k in range(0, len(parts), 2):
        text = SYMBOL.sub(lambda m: f"<i>{LETTERS.get(m[1], m[1])}</i>" + (f"<sub>{LETTERS.get(m[2], m[2])}</sub>" if m[2] else ""), parts[k])
        text = re.sub(r"\*\*_([A-Za-z0-9]+)", r"**<sub>\1</sub>", text)
        parts[k] = POWER.sub(lambda m: f"<sup>{m[1] or m[2]}</sup>", text)
    return "".join(parts)


def typeset(page):
    """The page with every block of indented lines, between empty ones, as KaTeX, and symbols of sentences; fenced blocks and headings stay."""
    lines, out, k, fenced = page.split("\n"), [], 0, False
    while k < len(lines):
        fenced ^= lines[k].startswith("```")
        begins = lines[k].startswith("    ") and not fenced and (k == 0 or not lines[k - 1].strip()) and not re.match(r"\s*[|>*-] ", lines[k])
        if not begins:
            out.append(lines[k] if fenced or lines[k].startswith(("#", "    ")) else sentence(lines[k]))
            k += 1
            continue
        end = k
        while end < len(lines) and lines[end].startswith("    "):
            end += 1
        out += block(lines[k:end])
        k = end
    return "\n".join(out)

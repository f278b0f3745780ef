#!/usr/bin/env python3
"""Checks a folder of HTML pages: every link meets a file and an anchor in it, and no page loads anything from a network.

check_links.py FOLDER; exit code 1 if not. Links that a reader may follow to other servers are counted, not asked.
"""
import html.parser
import pathlib
import sys
import urllib.parse

LOADS = {("script", "src"), ("img", "src"), ("iframe", "src"), ("source", "src"), ("video", "src"), ("link", "href")}


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.anchors, self.links = set(), []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.anchors.update(values[name] for name in ("id", "name") if values.get(name))
        for name in ("href", "src"):
            if values.get(name) is not None and not (tag == "link" and values.get("rel") == "canonical"):
                self.links.append((tag, name, values[name]))


def main(folder):
    pages = {path.resolve(): Page(path.read_text()) for path in sorted(folder.rglob("*.html"))}
    problems, links, outside = [], 0, 0
    for path, page in pages.items():
        if path.name == "404.html":  # its links begin at the root of a server
            continue
        for tag, name, value in page.links:
            parts = urllib.parse.urlsplit(value)
            if parts.scheme in ("http", "https") or parts.netloc:
                outside += 1
                if (tag, name) in LOADS:
                    problems.append(f"{path.relative_to(folder.resolve())} loads {value}")
                continue
            if parts.scheme in ("data", "mailto", "javascript"):
                continue
            links += 1
            target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            if target.is_dir():
                target = target / "index.html"
            if not target.exists():
                problems.append(f"{path.relative_to(folder.resolve())}: no {value}")
            elif parts.fragment and target in pages and urllib.parse.unquote(parts.fragment) not in pages[target].anchors:
                if parts.fragment not in ("__skip", "__consent"):
                    problems.append(f"{path.relative_to(folder.resolve())}: no place {value}")
    for style in folder.rglob("*.css"):
        if "url(http" in style.read_text():
            problems.append(f"{style} loads from a server")
    print(f"{len(pages)} pages, {links} links within, {outside} to elsewhere, {len(problems)} wrong")
    print("\n".join(problems[:50]))
    return 1 if problems or not pages else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))

#!/usr/bin/env python3
"""Checks the built site: links and their anchors lead somewhere, pictures have a text, nothing is loaded from another host.

    check_html.py HTML
"""
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LOADS = {"script": "src", "img": "src", "link": "href", "iframe": "src", "source": "src"}


class Page(HTMLParser):
    """Anchors, links and what is loaded, of one page."""

    def __init__(self, text):
        super().__init__()
        self.anchors, self.links, self.loaded, self.without_text = set(), [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.anchors.update(v for v in (attrs.get("id"), attrs.get("name")) if v)
        if tag == "a" and attrs.get("href"):
            self.links.append(attrs["href"])
        if attrs.get(LOADS.get(tag, "")):
            self.loaded.append(attrs[LOADS[tag]])
        if tag == "img" and not attrs.get("alt"):
            self.without_text.append(attrs.get("src", ""))


def check(root):
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in root.rglob("*.html") if root / "reference" not in path.parents}
    for path, page in pages.items():
        name = path.relative_to(root)
        yield from (f"{name}: {url[:60]} is loaded from elsewhere" for url in page.loaded if urlsplit(url).netloc)
        yield from (f"{name}: the picture {url[:60]} has no text" for url in page.without_text)
        for url in page.links + page.loaded:
            parts = urlsplit(url)
            if parts.scheme or parts.netloc:
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if not target.exists():
                yield f"{name}: there is no {url}"
            elif parts.fragment and target in pages and unquote(parts.fragment) not in pages[target].anchors:
                yield f"{name}: {url} has no such place"


if __name__ == "__main__":
    found = sorted(set(check(Path(sys.argv[1]).resolve())))
    print("\n".join(found) if found else "links, texts of pictures and what is loaded are well")
    sys.exit(1 if found else 0)

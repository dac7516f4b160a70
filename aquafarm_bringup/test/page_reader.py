# SPDX-License-Identifier: BSD-3-Clause
"""Reads the page of a plan in tests."""
import html.parser

VOID = {"meta", "input", "br"}


class Reader(html.parser.HTMLParser):
    """Reads the text, the element ids and the addresses of a page, and counts its scripts. Fails if
    its tags do not match."""

    def __init__(self, text):
        super().__init__()
        self.open, self.words, self.addresses, self.ids, self.scripts = [], "", [], [], 0
        self.feed(text)
        assert not self.open, f"left open: {self.open}"

    def handle_starttag(self, tag, attrs):
        self.words += " "
        self.addresses += [value for key, value in attrs if key in ("src", "href", "xlink:href")]
        self.ids += [value for key, value in attrs if key == "id"]
        self.scripts += tag == "script"
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, tag

    def handle_data(self, data):
        if not self.open or self.open[-1] not in ("script", "style"):
            self.words += data

# SPDX-License-Identifier: BSD-3-Clause
"""Reads the pages of plans and reports in tests."""
import base64
import html.parser
import pathlib

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


class Page(html.parser.HTMLParser):
    """Reads the elements, texts and addresses of the page of a report. Fails if its tags do
    not match."""

    def __init__(self, path):
        super().__init__()
        self.text = pathlib.Path(path).read_text()
        self.open, self.names, self.addresses, self.words, self.meta = [], [], [], "", {}
        self.feed(self.text)
        assert not self.open, f"left open: {self.open}"

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.names.append(tag)
        self.addresses += [attributes[key] for key in ("src", "href", "xlink:href")
                           if key in attributes]
        if tag == "meta" and "name" in attributes:
            self.meta[attributes["name"]] = attributes["content"]
        if tag not in ("meta", "img"):
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in ("meta", "img"):
            self.open.pop()

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, tag

    def handle_data(self, data):
        self.words += data

    def embedded(self, kind):
        """Returns the embedded files of a kind, such as video/mp4."""
        head = f"data:{kind};base64,"
        return [base64.b64decode(one[len(head):]) for one in self.addresses
                if one.startswith(head)]

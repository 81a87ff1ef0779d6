"""The book's pages, beside the page: the tuning guide and what each parameter does, also where there is no network."""

from __future__ import annotations

import re
from pathlib import Path

import markdown
from aiohttp import web

from stillspin import resources

_LINK = re.compile(r"(?<!!)\[([^\]]*)\]\((?!https?:|#)([^)#\s]*)[^)\s]*\)")
_PAGE = """\
<!doctype html>
<html lang="en">
<head>
  <meta charset="utf-8">
  <meta name="viewport" content="width=device-width, initial-scale=1">
  <title>{title} - stillspin</title>
  <link rel="icon" href="data:,">
  <link rel="stylesheet" href="/page/style.css">
  <link rel="stylesheet" href="/page/book.css">
</head>
<body class="book">
<main>
{content}
</main>
</body>
</html>
"""


def add_to(router: web.UrlDispatcher) -> None:
    """Serve the pages below /book, with their pictures."""
    pages = resources.book()

    async def give(request: web.Request) -> web.Response:
        page = pages / f"{request.match_info['name']}.md"
        if not page.is_file():
            raise web.HTTPNotFound(text="the book has no such page\n")
        return web.Response(text=rendered(page), content_type="text/html")

    router.add_get("/book/{name:[a-z0-9-]+}.md", give)
    router.add_static("/book/images", pages / "images")


def rendered(page: Path) -> str:
    """A page as HTML. Of a link that leads out of the book's folder, to a source for example, its words are left."""

    def words(match: re.Match[str]) -> str:
        known = "/" not in match[2] and (page.parent / match[2]).is_file()
        return match[0] if known else match[1]

    text = page.read_text(encoding="utf-8")
    title = text.partition("\n")[0].removeprefix("# ")
    content = markdown.markdown(_LINK.sub(words, text), extensions=["tables", "fenced_code", "toc"])
    return _PAGE.format(title=title, content=content)

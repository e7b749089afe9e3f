"""Pages of the library, as a notebook shows them."""

from __future__ import annotations

from html import escape


class Page(str):
    """The text of a page. A notebook shows it in a frame; ``Path(…).write_text(page, "utf-8")`` keeps it."""

    def _repr_html_(self) -> str:
        # No script of the page reaches the notebook.
        return (
            f'<iframe srcdoc="{escape(self)}" sandbox="allow-scripts" style="width: 100%; height: 640px; border: 0">'
            "</iframe>"
        )

    def __repr__(self) -> str:
        return f"<Page: {len(self) / 1e3:.0f} kB>"

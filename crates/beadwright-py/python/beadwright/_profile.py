"""Profiles: what wire, arc, machine and strategy are like."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeAlias

from beadwright import _core
from beadwright._errors import BeadwrightError

Value: TypeAlias = bool | int | float | str | list[Any] | dict[str, Any]


class Profile:
    """A profile, from the name of a built-in one or of one of your own (``BEADWRIGHT_PROFILES``), a path, or TOML text.

    >>> Profile("cmt-al2319-kuka").set({"bead.width": 5.0, "fill.strategy": "contour"})["bead.width"]
    5.0
    """

    __slots__ = ("_inner",)
    _inner: _core.Profile

    def __init__(self, source: str | os.PathLike[str] = "cmt-al2319-kuka") -> None:
        """Raises :class:`BeadwrightError` with the line, the key and what would be right."""
        if isinstance(source, str) and "\n" in source:
            text, place, folder = source, None, Path()
        else:
            text, place, folder = _found(os.fspath(source))
        self._inner = _core.Profile.parse(text, place, folder, _base(folder))

    @classmethod
    def _of(cls, core: _core.Profile) -> Profile:
        profile = object.__new__(cls)
        profile._inner = core
        return profile

    def set(self, values: Mapping[str, Value] | None = None, /, **named: Value) -> Profile:
        """A profile with other values: ``set({"bead.width": 5})`` or ``set(bead__width=5)``.

        Raises :class:`BeadwrightError` that names the key, its range and its unit.
        """
        given = dict(values or {}) | {key.replace("__", "."): value for key, value in named.items()}
        toml = [(key, _toml(key, value)) for key, value in given.items()]
        return Profile._of(self._inner.set(toml, _base(self._inner.folder)))

    @property
    def name(self) -> str:
        """Its name."""
        return self._inner.name

    @property
    def text(self) -> str:
        """Its TOML text, with the values set since."""
        return self._inner.text

    @property
    def values(self) -> dict[str, Any]:
        """All values, by section and key."""
        return self._inner.values

    @property
    def notes(self) -> list[str]:
        """What does not fit together in it, as sentences."""
        return self._inner.notes

    @property
    def key(self) -> str:
        """The same for profiles that mean the same, however they are written."""
        return self._inner.whole_text

    def __getitem__(self, key: str) -> Any:
        """The value of a key such as ``"bead.width"``."""
        value: Any = self.values
        for part in key.split("."):
            if not isinstance(value, dict) or part not in value:
                raise KeyError(key)
            value = value[part]
        return value

    def __reduce__(self) -> tuple[Any, ...]:
        return _remade, (self._inner.text, self._inner.folder)

    def __repr__(self) -> str:
        return f"<Profile {self.name}>"


def profiles() -> list[str]:
    """Names of the built-in profiles."""
    return _core.profile_names()


def strategies() -> list[str]:
    """Names of the strategies."""
    return _core.strategy_names()


def _remade(text: str, folder: Path) -> Profile:
    return Profile._of(_core.Profile.parse(text, None, folder, _base(folder)))


def _found(source: str) -> tuple[str, str | None, Path]:
    """Text, place and folder of a profile that is named or lies in a file."""
    path = _file(source)
    if path is None:
        return _core.Profile.built_in_text(source), source, Path()
    return _text(path), source, path.parent


def _file(source: str) -> Path | None:
    """The file that a name stands for: a path, or one of the user's own profiles."""
    path = Path(source)
    if path.suffix == ".toml" or len(path.parts) > 1 or path.is_file():
        return path
    own = _own_folder() / f"{source}.toml"
    return own if own.is_file() else None


def _own_folder() -> Path:
    """Where the command looks for profiles by their names, too."""
    if own := os.environ.get("BEADWRIGHT_PROFILES"):
        return Path(own)
    settings = os.environ.get("XDG_CONFIG_HOME") or os.environ.get("APPDATA")
    return (Path(settings) if settings else Path.home() / ".config") / "beadwright" / "profiles"


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not text in UTF-8"
        raise BeadwrightError(f"the profile {path} cannot be read: {reason}.", str(path)) from error


def _base(folder: Path) -> Callable[[str], str | None]:
    """Fetches what ``inherits`` names, from the folder of the profile that does; ``None`` for a built-in one."""
    here = folder

    def text(name: str) -> str | None:
        nonlocal here
        path = _file(name)
        if path is None:
            return None
        path = here / path
        here = path.parent
        return _text(path)

    return text


def _toml(key: str, value: Value) -> str:
    """A value in TOML, whose strings are written as in JSON."""
    if hasattr(value, "item"):
        # A NumPy number, some of which are also Python floats.
        value = value.item()
    if isinstance(value, bool | str):
        return json.dumps(value)
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, list | tuple):
        return f"[{', '.join(_toml(key, item) for item in value)}]"
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{json.dumps(name)} = {_toml(key, item)}' for name, item in value.items())} }}"
    raise BeadwrightError(f"{key}: a value of type {type(value).__name__} cannot be in a profile.", key)

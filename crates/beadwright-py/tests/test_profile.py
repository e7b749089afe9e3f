"""Profiles: values that are set, files, and what is refused."""

from __future__ import annotations

import pickle
import tomllib
from pathlib import Path

import numpy as np
import pytest

from beadwright import BeadwrightError, Profile, profiles, strategies


def test_built_in_profiles_are_read() -> None:
    for name in profiles():
        assert Profile(name).name == name
    assert "contour" in strategies()


def test_values_are_those_of_the_text() -> None:
    profile = Profile("cmt-al2319-kuka")
    read = tomllib.loads(profile.text)
    assert profile["bead.width"] == read["bead"]["width"]
    assert profile.values["layers"]["height"] == read["layers"]["height"]
    with pytest.raises(KeyError):
        profile["bead.colour"]


def test_values_are_set_by_either_name() -> None:
    first = Profile().set({"bead.width": 5.0, "fill.strategy": "contour"})
    second = Profile().set(bead__width=5, fill__strategy="contour")
    assert first["bead.width"] == second["bead.width"] == 5.0
    assert first.key == second.key
    assert first.key != Profile().key
    assert Profile()["bead.width"] == 7.54, "the profile itself stays as it is"


def test_values_of_numpy_and_lists_are_set() -> None:
    profile = Profile().set({"bead.width": np.float64(6.5), "posts": ["krl"], "description": 'a "quoted" word'})
    assert profile["bead.width"] == 6.5
    assert profile["posts"] == ["krl"]
    assert profile["description"] == 'a "quoted" word'


def test_a_value_that_cannot_be_names_key_range_and_unit() -> None:
    with pytest.raises(BeadwrightError, match="bead.width = -1 is impossible.* mm") as caught:
        Profile().set(bead__width=-1)
    assert caught.value.place == "bead.width"


def test_a_key_that_is_not_there() -> None:
    with pytest.raises(BeadwrightError, match="widht") as caught:
        Profile().set({"bead.widht": 5})
    assert caught.value.place == "bead.widht"


def test_a_type_that_cannot_be() -> None:
    with pytest.raises(BeadwrightError, match="of type object cannot be in a profile"):
        Profile().set({"bead.width": object()})  # type: ignore[dict-item]


def test_a_name_that_is_not_there_names_the_nearest() -> None:
    with pytest.raises(BeadwrightError, match="cmt-al2319-kuka"):
        Profile("cmt-al2319-kuk")


def test_errors_in_text_name_the_line() -> None:
    text = Profile().text.replace("width = 7.54", "width = = 7.54")
    line = text.splitlines().index(next(each for each in text.splitlines() if "= =" in each)) + 1
    with pytest.raises(BeadwrightError) as caught:
        Profile(text)
    assert caught.value.place == f"line {line}"


def test_a_file_inherits_from_one_beside_it(tmp_path: Path) -> None:
    (tmp_path / "base.toml").write_text(Profile().set(bead__width=6.0).text)
    (tmp_path / "own.toml").write_text('inherits = "./base.toml"\n[layers]\nheight = 1.5\n')
    profile = Profile(tmp_path / "own.toml")
    assert (profile["bead.width"], profile["layers.height"]) == (6.0, 1.5)
    assert profile.set(layers__height=1.25)["bead.width"] == 6.0, "the folder is remembered"


def test_an_own_profile_is_called_by_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "shop.toml").write_text('inherits = "cmt-al2319-kuka"\nname = "shop"\n[bead]\nwidth = 7.0\n')
    monkeypatch.setenv("BEADWRIGHT_PROFILES", str(tmp_path))
    assert Profile("shop")["bead.width"] == 7.0


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(BeadwrightError, match="none.toml cannot be read"):
        Profile(tmp_path / "none.toml")


def test_what_inherits_from_a_missing_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "own.toml").write_text('inherits = "./gone.toml"\n')
    with pytest.raises(BeadwrightError, match="gone.toml cannot be read"):
        Profile(tmp_path / "own.toml")


def test_a_profile_travels_to_another_process() -> None:
    profile = Profile().set(bead__width=5)
    assert pickle.loads(pickle.dumps(profile)).key == profile.key

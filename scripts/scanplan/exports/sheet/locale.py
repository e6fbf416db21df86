"""How a sheet is written: units of lengths and areas, language, numbers and dates."""

import re
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import date
from functools import cached_property
from typing import Any

_FOOT_M = 0.3048
_INCH_M = _FOOT_M / 12
_INCH_PARTS = 4  # of an inch, 6 mm: as fine as lengths are stated in metres
_FINE_M = 0.01  # of errors: less is stated to a tenth of a millimetre
_PER_M = {"m": 1.0, "cm": 100.0, "mm": 1000.0}
_DECIMALS = {"m": 2, "cm": 0, "mm": 0}
_NUMBER = r"[~+-]?\d[\d.,'\" /%-]*"
_DATE = re.compile(r"(\d{4})-(\d\d)-(\d\d)")
_PLACES = {r"\{n\}": f"({_NUMBER})", r"\{\}": "(.+?)"}


@dataclass(frozen=True)
class Locale:
    """Units and words of those who receive a sheet.

    Attributes
    ----------
    unit : str
        m, cm, mm or ft: of lengths in drawings; areas are in square metres or square feet.
    decimal : str
        The sign between a number's whole and its decimals.
    date : str
        Of days, as strftime has it.
    phrases : dict of str to str
        English phrases and what they are in another language. `{n}` stands for a number, `{}` for
        any words, which are translated in turn; in the other language also `{1}` for the first of
        them, `{2}` for the second and so on.
    """

    unit: str = "m"
    decimal: str = "."
    date: str = "%Y-%m-%d"
    phrases: Mapping[str, str] = field(default_factory=dict, repr=False)

    @property
    def is_imperial(self) -> bool:
        """Whether lengths are in feet and inches."""
        return self.unit == "ft"

    @property
    def per_m(self) -> float:
        """Units for a metre; of feet metres, as feet are written as words."""
        return _PER_M.get(self.unit, 1.0)

    @property
    def decimals(self) -> int:
        """Of lengths, where they are numbers."""
        return _DECIMALS.get(self.unit, 2)

    @property
    def area_unit(self) -> str:
        """The unit of areas."""
        return "ft²" if self.is_imperial else "m²"

    def length(self, length_m: float) -> str:
        """Return a length without its unit; feet and inches have their signs.

        >>> Locale("cm").length(2.004), Locale("mm").length(2.004), Locale(decimal=",").length(2)
        ('200', '2004', '2,00')
        """
        if self.is_imperial:
            return _format_feet(length_m)
        return f"{length_m * self.per_m:.{self.decimals}f}".replace(".", self.decimal)

    def measure(self, length_m: float, decimals: int = 2) -> str:
        """Return a length with its unit, in metres with so many decimals."""
        if self.unit == "m":
            return f"{length_m:.{decimals}f} m".replace(".", self.decimal)
        return self.length(length_m) + f" {self.unit}" * (not self.is_imperial)

    def size(self, length_m: float) -> str:
        """Return a thickness or a width with its unit, to half a centimetre where it is metric.

        >>> Locale().size(0.3649), Locale("mm").size(0.115), Locale(decimal=",").size(0.115)
        ('36.5 cm', '115 mm', '11,5 cm')
        """
        if self.is_imperial:
            return self.length(length_m)
        half_cm = round(200 * length_m)
        said = f"{5 * half_cm} mm" if self.unit == "mm" else f"{half_cm / 2:g} cm"
        return said.replace(".", self.decimal)

    def girth(self, length_m: float) -> str:
        """Return a long way around with its unit, in whole feet where it is in feet."""
        return f"{length_m / _FOOT_M:.0f} ft" if self.is_imperial else self.measure(length_m)

    def area(self, area_m2: float) -> str:
        """Return an area with its unit, to a tenth of a square metre or a square foot."""
        if self.is_imperial:
            return f"{area_m2 / _FOOT_M**2:.0f} ft²"
        return f"{area_m2:.1f} m²".replace(".", self.decimal)

    def deviation(self, length_m: float) -> str:
        """Return what something is off by, in millimetres or inches."""
        if self.is_imperial:
            return f"{length_m / _INCH_M:.1f} in".replace(".", self.decimal)
        return f"{1000 * length_m:.0f} mm"

    def error(self, length_m: float) -> str:
        """Return what is not known of a length: in tenths of a millimetre below 10 mm, or inches.

        >>> Locale(decimal=",").error(0.0042), Locale().error(0.022), Locale("ft").error(0.022)
        ('4,2 mm', '22 mm', '0.87 in')
        """
        said = f"{1000 * length_m:.{1 if length_m < _FINE_M else 0}f} mm"
        if self.is_imperial:
            said = f"{length_m / _INCH_M:.2f} in"
        return said.replace(".", self.decimal)

    @property
    def fine(self) -> tuple[float, str]:
        """The unit of small distances: how many a metre has, and its name."""
        if self.is_imperial:
            return 1 / _INCH_M, "in"
        return (1000.0, "mm") if self.unit == "mm" else (100.0, "cm")

    @property
    def bar(self) -> tuple[float, str]:
        """The unit of scale bars: its length in metres, and its name."""
        return (_FOOT_M, "ft") if self.is_imperial else (1.0, "m")

    def say(self, text: str) -> str:
        """Return an English text in the language, its numbers and dates as they are written there.

        What has no phrase is taken apart at semicolons and commas, and stays if none of that has.
        """
        for pattern, words in self._patterns:
            found = pattern.fullmatch(text)
            if found:
                return words.format(*map(self.say, found.groups()))
        for separator in ("; ", ", "):
            parts = text.split(separator)
            said = [self.say(part) for part in parts] if len(parts) > 1 else parts
            if said != parts:
                return separator.join(said)
        return self._write(text)

    def fill(self, phrase: str, *words: str) -> str:
        """Return an English phrase in the language, its places `{}` filled with words as they are.

        >>> Locale(phrases={"at {} of {}": "{2}: {1}"}).fill("at {} of {}", "no", "Room 1")
        'Room 1: no'
        """
        said = self.phrases.get(phrase, phrase)
        return re.sub(r"\{(\d)\}", lambda at: f"{{{int(at[1]) - 1}}}", said).format(*words)

    def title(self, text: str) -> str:
        """Return an English text in the language, with a capital at its beginning.

        >>> Locale(phrases={"toilet": "WC"}).title("toilet"), Locale().title("not known")
        ('WC', 'Not known')
        """
        said = self.say(text)
        return said[:1].upper() + said[1:]

    @cached_property
    def _patterns(self) -> list[tuple[re.Pattern[str], str]]:
        """Phrases as patterns: those with most letters first, as they say most."""
        found: list[tuple[re.Pattern[str], str]] = []
        for phrase in sorted(self.phrases, key=lambda phrase: (-len(phrase), phrase)):
            pattern = re.escape(phrase)
            for place, group in _PLACES.items():
                pattern = re.sub(place.replace("\\", "\\\\"), lambda _, g=group: g, pattern)
            words = re.sub(r"\{n\}", "{}", self.phrases[phrase])
            # numbered from 1: a language has an order of its own
            words = re.sub(r"\{(\d)\}", lambda place: f"{{{int(place[1]) - 1}}}", words)
            found.append((re.compile(pattern), words))
        return found

    def credit(self, text: str) -> str:
        """Return what was done, by whom and when: names stay as they are.

        >>> Locale(date="%d.%m.%Y", phrases={"no": "nein"}).credit("kept by hand, no, 2026-03-01")
        'kept by hand, no, 01.03.2026'
        """
        done, *others = text.split(", ")
        return ", ".join([self.say(done), *map(self.day, others)])

    def day(self, text: str) -> str:
        """Return a day (2026-03-01) as it is written there; any other text as it is."""
        day = _DATE.fullmatch(text)
        # a name may look like a day that is none
        with suppress(ValueError):
            return date(*map(int, day.groups())).strftime(self.date) if day else text
        return text

    def _write(self, text: str) -> str:
        if (said := self.day(text)) != text:
            return said
        if re.fullmatch(_NUMBER, text):
            return re.sub(r"(?<=\d)\.(?=\d)", self.decimal, text)
        return text


ENGLISH = Locale()
"""Metres, English: as everything is written where nothing else is asked for."""


def _format_feet(length_m: float) -> str:
    parts = round(abs(length_m) / _INCH_M * _INCH_PARTS)
    sign = "-" if length_m < 0 and parts else ""
    feet, left = divmod(parts, 12 * _INCH_PARTS)
    inches, fraction = divmod(left, _INCH_PARTS)
    over = {1: " 1/4", 2: " 1/2", 3: " 3/4"}.get(fraction, "")
    return f"{sign}{feet}'-{inches}{over}\""


def make_locale(unit: str, words: Mapping[str, Any] | None) -> Locale:
    """Return how sheets are written, with the words of `words_file.read_words`; English of none."""
    return Locale(unit, **words) if words else Locale(unit)

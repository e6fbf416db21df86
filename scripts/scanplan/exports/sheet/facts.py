"""What a title block states beside its plan: of the survey, of the people, and of the place."""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from scanplan.exports.model_origin import North, Site, find_site
from scanplan.exports.sheet.accuracy import CLOCKS_SIGMA, SensorErrors
from scanplan.exports.sheet.locale import ENGLISH, Locale
from scanplan.plan.floorplan import FloorPlan, GeoReference
from scanplan.recordings.clocks import state_date
from scanplan.types import Columns, Settings


@dataclass(frozen=True)
class SheetFacts:
    """What a title block states beside the plan.

    Attributes
    ----------
    project, storey : str
        Empty where not given.
    surveyed : str
        Day of the survey, by the recording's stamps.
    n_scans : int
        Scans that the plan is made of.
    version : str
        Of the software.
    number, of : int
        Which sheet of a set of how many it is.
    sensor : accuracy.SensorErrors
    drawing : str
        What kind of drawing it is.
    north : model_origin.North or None
        None where not known.
    locale : Locale
        How the sheet is written.
    frame : str
        Where the map lies on earth; empty where not known.
    author, organisation : str
        Empty where not given.
    """

    project: str = ""
    storey: str = ""
    surveyed: str = "not known"
    n_scans: int = 0
    version: str = ""
    number: int = 1
    of: int = 1
    sensor: SensorErrors = field(default_factory=SensorErrors)
    drawing: str = "Floor plan, as surveyed"
    north: North | None = None
    locale: Locale = ENGLISH
    frame: str = ""
    author: str = ""
    organisation: str = ""

    @property
    def answerable(self) -> str:
        """Who answers for the drawing, as files state their author; empty where not given."""
        return ", ".join(filter(None, [self.author, self.organisation]))


def gather_facts(
    evidence: Columns, plan: FloorPlan, settings: Settings, locale: Locale, version: str
) -> SheetFacts:
    """Return what the title block of a plan's sheet states.

    Parameters
    ----------
    evidence : dict of str to (n,) array
        The columns of `schemas.EVIDENCE`.
    settings : dict
        See `stage_settings.select_drawing`.
    version : str
        Of the software.
    """
    site = find_site(plan.georeference, settings["site"])
    people = ("project", "storey", "author", "organisation")
    return summarise_survey(
        evidence,
        **{name: settings[name] or "" for name in people},
        version=version,
        sensor=SensorErrors(settings["range_offset_sigma_m"], CLOCKS_SIGMA),
        north=site.north,
        locale=locale,
        frame=state_frame(site, plan.georeference, locale),
    )


def summarise_survey(evidence: Columns, **stated: Any) -> SheetFacts:
    """Return what a title block states of the scans that a plan is made of.

    Parameters
    ----------
    evidence : dict of str to (n,) array
        The columns of `schemas.EVIDENCE`.
    **stated
        Other attributes of `SheetFacts`.
    """
    t_ns = evidence["t_ns"]
    facts = SheetFacts(n_scans=len(np.unique(evidence["scan_id"])), **stated)
    return replace(facts, surveyed=state_date(int(t_ns.min()))) if len(t_ns) else facts


def state_frame(site: Site, measured: GeoReference | None, locale: Locale = ENGLISH) -> str:
    """Return in words where a map lies on earth, and how well reference points agree with it."""
    if not site.is_placed:
        return ""
    origin = f"origin E {site.east_m:.3f} N {site.north_m:.3f}"
    place = f"{origin}, x axis {site.turn_deg:.4f}° from E, scale 1"
    if measured is None:
        return f"{site.crs}: {place}"
    residual = f"residual {locale.deviation(measured.residual_m)}"
    if measured.check_off_m:
        residual += f"; checks {locale.deviation(measured.check_rms_m)}"
    return f"{site.crs}: {place}; {residual}"

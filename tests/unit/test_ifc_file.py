"""Building models made here, whose every face is known, and the ways a file can be broken."""

import numpy as np
import pytest

from helpers import ifc_making
from scanplan.design import ifc_file
from scanplan.design.storey_choice import find_storey
from scanplan.errors import StageError

DATA = ifc_making.model()


@pytest.mark.parametrize("millimetres", [False, True])
def test_parts_are_in_metres_and_labelled(millimetres):
    model = ifc_file.parse_ifc(ifc_making.model(millimetres=millimetres), "made.ifc")
    kinds = sorted(part.kind for part in model.parts)
    assert kinds == sorted(
        ["wall"] * 4 + ["slab", "furniture", "space", "door", "glass", "opening", "opening"]
    )
    (table,) = (part for part in model.parts if part.kind == "furniture")
    corners = table.triangles_m.reshape(-1, 3)
    np.testing.assert_allclose(
        [corners.min(0), corners.max(0)], [[3.2, 2.2, 0], [4.0, 3.0, 0.7]], atol=1e-6
    )
    assert {part.fills for part in model.parts if part.kind == "opening"} == {"door", "window"}
    assert model.storeys == (("Ground", 0.0),) and model.notes == ()


def test_storeys_are_chosen_by_name_or_index():
    model = ifc_file.parse_ifc(ifc_making.model(("Ground", "Upper")), "made.ifc")
    assert [name for name, _ in model.storeys] == ["Ground", "Upper"]
    assert model.storeys[1][1] == pytest.approx(2.7)
    key = "plan.design.storey"
    found = [find_storey(model.storeys, of, "made.ifc", key) for of in ("Upper", 0, 1)]
    assert found == [1, 0, 1]
    for chosen in (None, "Attic", 2, -1):
        said = r"made\.ifc: .*plan\.design\.storey .*0 'Ground' at 0\.00 m, 1 'Upper' at 2"
        with pytest.raises(StageError, match=said):
            find_storey(model.storeys, chosen, "made.ifc", key)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", r"is empty \(0 bytes\)"),
        (DATA[: len(DATA) // 2], "does not run from ISO-10303-21 to END"),
        (b"solid cube", "no IFC file"),
        (b"ISO-10303-21;\nEND-ISO-10303-21;\n", "made.ifc: "),
        (
            b"ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC9'));\nENDSEC;\nEND-ISO-10303-21;\n",
            "made.ifc: ",
        ),
        (b"\xff\xfe" * 20, "no IFC file"),
    ],
)
def test_what_is_no_model_is_refused_in_one_line(data, message):
    with pytest.raises(StageError, match=message) as refusal:
        ifc_file.parse_ifc(data, "made.ifc")
    assert "\n" not in str(refusal.value)

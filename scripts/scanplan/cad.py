"""The plan as DXF, for CAD programs."""

import io
from contextlib import contextmanager

import ezdxf
from ezdxf import units, zoom

LAYER = "WALLS"
_LINEWEIGHT = 35  # hundredths of a millimetre


def dumps(faces):
    """Return the faces of a plan as the text of a DXF R2010 file: lines on the layer WALLS, in metres.

    Parameters
    ----------
    faces : dict of str to (n,) array
        The columns of `schemas.FACES`.

    Returns
    -------
    str
        The same for the same faces: no time, no random identifier.

    Raises
    ------
    ValueError
        If the drawing does not pass the audit of ezdxf.
    """
    with _fixed_metadata():
        document = ezdxf.new("R2010", units=units.M)
        document.layers.add(LAYER, lineweight=_LINEWEIGHT)
        modelspace = document.modelspace()
        for x0_m, y0_m, x1_m, y1_m in zip(*(faces[c].tolist() for c in ("x0_m", "y0_m", "x1_m", "y1_m")), strict=True):
            modelspace.add_line((x0_m, y0_m), (x1_m, y1_m), dxfattribs={"layer": LAYER})
        zoom.extents(modelspace)
        _audit(document)
        # ezdxf would register these in the order of a set, which differs from run to run
        for name in sorted(document.entitydb.dxf_types_in_use()):
            document.classes.add_class(name)
        text = io.StringIO()
        document.write(text)
    return text.getvalue()


def _audit(document):
    faults = document.audit().errors
    if faults:
        raise ValueError(f"the drawing has {len(faults)} faults, the first: {faults[0].message}")


@contextmanager
def _fixed_metadata():
    kept = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = kept

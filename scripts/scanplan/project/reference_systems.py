"""Reference systems of the Earth by their EPSG codes: which give metres on a map.

Standard library only: this runs while the workflow is being parsed.
"""

import re

_CODE = re.compile(r"EPSG:[0-9]+")
_CODES = range(1024, 32768)
"""What the EPSG registry gives out."""
_IN_DEGREES = """
    3819-3824 3887-3889 3906 4000-4025 4027-4036 4039-4047 4052-4055 4073-4081 4120-4216
    4218-4389 4463-4466 4468-4470 4472-4473 4475-4483 4490 4555-4558 4600-4646 4657-4765
    4801-4811 4813-4821 4823-4824 4882-5013 5132 5228-5233 5244-5246 5250-5252 5262-5264
    5322-5324 5332 5340-5342 5352-5354 5358-5360 5363-5365 5368-5381 5391-5393 5451 5464 5467
    5487-5489 5524-5527 5544-5546 5558 5560-5561 5591-5593 5681 5828-5830 5884-5886 6133-6135
    6207 6309-6311 6317-6325 6363-6365 6666-6668 6704-6706 6781-6783 6881-6883 6892 6894 6934
    6978-6983 6985-6990 7034-7042 7071-7073 7084-7088 7133-7139 7371-7373 7656-7686 7789
    7796-7798 7815-7816 7842-7844 7879-7881 7884-7886 7900-7931 8042-8043 8084-8086 8227-8255
    8351 8397-8431 8449 8541-8545 8683-8685 8694-8699 8816-8818 8860-8902 8905-8907 8915-8949
    8972-9019 9053-9140 9146-9148 9151-9153 9182-9184 9248 9251 9253 9266-9267 9292-9294 9299
    9307-9309 9331-9333 9364 9372 9378-9384 9403 9453 9468-9470 9474-9475 9545-9547 9694-9696
    9700-9702 9739 9753-9758 9763 9775-9784 9866 9871 9892-9893 9939 9964 9969 9974 9988-9990
    10158 10175-10178 10185 10191 10196 10204 10209 10214 10219 10224 10229 10237 10249 10252
    10256 10260 10265 10268 10272 10277 10282-10284 10297-10305 10307-10312 10326-10328
    10345-10346 10412-10414 10468 10473-10475 10569-10571 10604-10606 10623 10628 10634-10639
    10669-10673 10688-10690 10723-10725 10734-10739 10758 10760-10762 10779-10785 10789-10791
    10798-10800 10805-10807 10829-10831 10849 10860 10873-10898 10908-10910 10939-10941
    10950-10968 11041-11043 20033 20039-20041 20044-20046
"""
"""Codes of geographic and geocentric systems in EPSG v12.029, and those between that are free:
metres taken for degrees lie nowhere on Earth."""


def find_fault(name: str) -> str | None:
    """Return what is wrong with the name of a projected system; None where nothing is known to be.

    Parameters
    ----------
    name : str
        `EPSG:25832`; any other name may be that of a site's own grid.
    """
    if not name.upper().startswith("EPSG"):
        return None
    if not _CODE.fullmatch(name):
        return "expected EPSG and a number, such as EPSG:25832"
    code = name.partition(":")[2].lstrip("0")
    # more digits than any has may be more than Python reads
    if len(code) > 5 or int(code or 0) not in _CODES:
        return f"expected a code of {_CODES[0]} to {_CODES[-1]}, such as EPSG:25832"
    if any(int(code) in codes for codes in _list_ranges()):
        return "is a system in degrees; give a projected one, in metres, such as EPSG:25832"
    return None


def _list_ranges() -> list[range]:
    ends = (word.partition("-") for word in _IN_DEGREES.split())
    return [range(int(first), int(last or first) + 1) for first, _, last in ends]

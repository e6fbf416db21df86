"""What the figures of the house count."""

import ast
from pathlib import Path

import pytest

import house_figures
import house_finds
import house_shapes
from house_finds import Module

TEXT = '''"""A module."""

_REACH_M = 0.3  # beyond it noise is larger
_LOW, _HIGH = 1, 2
# half of a door
_HALF_M: float = 1.9 / 2
NAMES = ("one", "two")
_SIZES = (1, 2)
_ANGLE = np.deg2rad(5)
FEW = 3
"""One or two may be stray."""


def typed(a: int, *, b: str = "x") -> int:
    """Return a."""
    return a


def untyped(a):
    return a


def _private(a):
    return a


class Shown:
    def method(self) -> None: ...

    def other(self, a): ...
'''


@pytest.fixture
def module(tmp_path):
    (tmp_path / "scanplan/plan").mkdir(parents=True)
    (tmp_path / "scanplan/plan/walls.py").write_text(TEXT)
    (module,) = house_finds.read_modules(tmp_path)
    return module


def test_numeric_constants_and_their_reasons(module):
    constants = list(house_finds.find_numeric_constants(module))
    assert [count for _, count in constants] == [1, 2, 1, 1, 1, 1]
    reasons = [house_finds.has_reason(module, statement) for statement, _ in constants]
    assert reasons == [True, False, True, False, False, True]


def test_public_functions_and_their_types(module):
    public = list(house_finds.find_public_functions(module))
    assert [function.name for function in public] == ["typed", "untyped", "method", "other"]
    assert [house_finds.is_annotated(function) for function in public] == [True, False] * 2
    assert house_finds.find_unannotated([module])[0].endswith("walls.py:19 untyped")
    assert house_finds.count_lines(public[0]) == 2


def test_names_that_two_modules_share(module):
    other = Module(module.path.with_name("rooms.py"), [], ast.parse("def typed(): ..."))
    found = house_finds.find_duplicate_names([module, other])
    assert found == ["typed (rooms)", "typed (walls)"]


def test_long_lines(module):
    assert house_finds.find_long_lines([module]) == []
    long = Module(module.path, ["#" * 101], ast.parse(""))
    assert len(house_finds.find_long_lines([long])) == 1


def test_keys_with_values(tmp_path):
    (tmp_path / "config.yaml").write_text("a: {b: 1, c: {d: [1, 2]}}\ne: null\nf: {}\n")
    assert house_finds.count_keys(tmp_path / "config.yaml") == 4


def function(text):
    return ast.parse(text).body[0]


def test_parameters_are_counted_but_for_the_object_itself():
    assert house_shapes.count_parameters(function("def f(self, a, /, b, *c, d=1, **e): ...")) == 5
    few, many = "def few(a, b, c, d, e, f): ...", "def many(a, b, c, d, e, f, *, g): ..."
    module = Module(Path("scanplan/a.py"), [], ast.parse(f"{few}\n{many}"))
    assert house_finds.find_long_parameter_lists([module]) == ["scanplan/a.py:2 many (7)"]


@pytest.mark.parametrize(
    ("body", "chain"),
    [
        ("    a = f(x)\n    b = g(a)\n    b = h(b, a)\n    return k(b)", ["a", "b", "b"]),
        # what hangs on nothing before it, or calls nothing, goes on with no chain
        ("    a = f(x)\n    b = a + 1\n    c = g(b)\n    d = g(x)", ["a"]),
        ("    if x:\n        a = f(x)\n    else:\n        a = g(x)\n    c, d = h(a)", ["a", "c"]),
        ("    for y in x:\n        a = f(y)\n        a += g(a)", ["a", "a"]),
        ("    return x", []),
    ],
)
def test_a_chain_is_of_calls_each_made_of_what_one_before_it_gave(body, chain):
    assert house_shapes.find_chain(function(f"def one(x):\n{body}")) == chain


def test_numbers_in_metres_or_shares_are_found_outside_the_model(module):
    model = Module(Path("scanplan/plan/model/priors.py"), module.lines, module.tree)
    found = house_finds.find_lengths_and_shares([module, model])
    assert found == ["scanplan/plan/walls.py:3 _REACH_M", "scanplan/plan/walls.py:6 _HALF_M"]
    text = "def f(a=0.1):\n    return [a * 2.0, a / 0.25, 3, 0.25]\nX = 0.5\n"
    plain = Module(Path("scanplan/plan/rooms.py"), [], ast.parse(text))
    places = ["1 0.1", "2 0.25", "2 0.25"]
    expected = [f"scanplan/plan/rooms.py:{place}" for place in places]
    assert house_finds.list_fractions([plain]) == expected


BLOCK = "a = one(1)\nb = a + 2\nfor c in b:\n    d = c.e\n    f(d)\ng = [h]\n"


def test_lines_that_stand_twice_are_counted_in_runs_of_six():
    longer = f"import x\n\n{BLOCK}\n# a comment\ni = 1\n"
    files = {"one.py": BLOCK, "two.py": longer}
    assert house_shapes.find_repeated(files, by_shape=False) == {"one.py": 6, "two.py": 6}
    assert house_shapes.find_repeated({"one.py": BLOCK}, by_shape=False) == {}
    shorter = BLOCK.replace("g = [h]\n", "")
    files = {"one.py": shorter, "two.py": shorter}
    assert house_shapes.find_repeated(files, by_shape=False) == {}


def test_lines_of_the_same_shape_differ_in_names_and_numbers_alone():
    other = BLOCK.replace("one", "two").replace("1", "7").replace("[h]", "[k]")
    alike = {"one.py": BLOCK, "two.py": other}
    assert house_shapes.find_repeated(alike, by_shape=False) == {}
    assert house_shapes.find_repeated(alike, by_shape=True) == {"one.py": 6, "two.py": 6}
    unlike = alike | {"two.py": other.replace("+", "-")}
    assert house_shapes.find_repeated(unlike, by_shape=True) == {}


SCHEMA = """properties:
  seed: {default: 1}
  plan:
    properties:
      method: {default: hull}
      advanced: {properties: {voxel_m: {default: 0.1}}}
"""


@pytest.fixture
def checkout(tmp_path):
    files = {
        "scripts/scanplan/plan/walls.py": TEXT,
        "scripts/thesis/claims.py": "def claim(a): ...\n",
        "scripts/assemble_plan.py": "X_M = 1\n",
        "config/config.yaml": "seed: 1\nplan: {method: hull}\n",
        "workflow/schemas/config.schema.yaml": SCHEMA,
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


def test_a_checkout_in_figures(checkout):
    figures = house_figures.count_house(checkout)
    assert (figures.files, figures.keys, figures.visible_keys) == (3, 3, 2)
    assert (figures.lengths_and_shares, figures.numeric_constants) == (3, 8)
    table = house_figures.format_figures({"before": figures, "after": figures})
    assert "basedpyright" not in table
    assert len({line.split()[-1] == line.split()[-2] for line in table.splitlines()[1:]}) == 1


def test_packages_have_their_files_and_lines(checkout):
    counted = house_finds.count_package_lines(house_finds.read_modules(checkout / "scripts"))
    n_lines = len(TEXT.splitlines())
    assert counted == {"scanplan/plan": (1, n_lines), "stages": (1, 1), "thesis": (1, 1)}
    rows = house_figures.format_packages({"before": {}, "after": counted}).splitlines()
    assert [row.split() for row in rows[1:]][1] == ["stages", "-", "1", "(1)"]


def test_places_of_what_is_counted_are_told(checkout):
    text = house_figures.format_places(checkout)
    for place in ("plan.advanced.voxel_m", "assemble_plan.py:1 X_M", "scanplan/plan/walls.py:3"):
        assert f"\n  {place}" in text


@pytest.mark.parametrize(
    ("body", "is_prose"),
    [
        ('assert told == "3 of 4 walls were seen"', True),
        ('assert told == "walls_m" and "run again" in told', False),
        ('with raises(StageError, match="does not exist any more"): read()', True),
        ('with raises(StageError, match=f"{path}: .* --config"): read()', False),
        ('print("what is asserted nowhere")', False),
        ('with refused(file="a.bag", remedy="rename it"): read()', False),
        ('with refused(value="no scan was kept"): read()', True),
        ("assert \"document.querySelector('#a .b').textContent\" in page", False),
    ],
)
def test_tests_of_wording_are_found(body, is_prose):
    (test,) = ast.parse(f"def test_of_it():\n    {body}\n").body
    assert house_shapes.asserts_prose(test) == is_prose


@pytest.mark.parametrize("marks", ["@pytest.mark.wording", ""])
def test_words_that_are_the_interface_are_left_out(marks):
    (test,) = ast.parse(f'{marks}\ndef test_it():\n    assert "room: 3 doors lead out of it"').body
    assert house_shapes.asserts_prose(test) == (not marks)


def test_modules_of_wording_are_left_out(tmp_path):
    body = 'def test_it():\n    assert said == "no scan was kept"\n'
    (tmp_path / "test_a.py").write_text(body)
    (tmp_path / "test_b.py").write_text(f"pytestmark = pytest.mark.wording\n{body}")
    found = house_finds.find_prose_tests(house_finds.read_modules(tmp_path))
    assert found == ["test_a.py:1 test_it"]


def test_words_that_are_given_to_the_code_are_left_out(tmp_path):
    begin = 'def test_it():\n    """No scan was kept."""\n    '
    (tmp_path / "test_a.py").write_text(f'{begin}assert run("no scan was kept")\n')
    (tmp_path / "test_b.py").write_text(
        f'{begin}said = run("stage: no scan was kept")\n    assert said == "no scan was kept"\n'
    )
    found = house_finds.find_prose_tests(house_finds.read_modules(tmp_path))
    assert found == ["test_a.py:1 test_it"]


def test_phrases_of_parameters_count_where_they_are_matched():
    text = '@parametrize("said", ["no scan was kept"])\ndef test_it(said):\n    '
    (matched,) = ast.parse(text + "with raises(E, match=said): read()").body
    (other,) = ast.parse(text + "read(said)").body
    assert house_shapes.asserts_prose(matched) and not house_shapes.asserts_prose(other)

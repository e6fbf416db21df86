from hypothesis import given
from hypothesis import strategies as st

from helpers.default_settings import SETTINGS
from scanplan.project.stage_settings import select_section
from scanplan.registration import batches
from scanplan.registration.registration_settings import registration_settings


def test_batches_follow_each_other_and_look_back():
    assert batches.cut_batches(10, 4, 2) == [(0, 0, 4), (2, 4, 8), (6, 8, 10)]
    assert batches.cut_batches(3, 100, 5) == [(0, 0, 3)]
    assert batches.cut_batches(0, 4, 2) == []


@given(n=st.integers(0, 60), size=st.integers(1, 20), n_chunks=st.integers(1, 8))
def test_chunks_have_each_batch_once_and_cut_none(n, size, n_chunks):
    settings = registration_settings(
        select_section(SETTINGS, "registration") | {"batch_size": size}
    )
    chunks = [f"{number}-of-{n_chunks}" for number in range(1, n_chunks + 1)]
    of_chunks = [batches.cut_survey(n, settings, chunk) for chunk in chunks]
    assert [batch for cut in of_chunks for batch in cut] == batches.cut_survey(n, settings)
    lengths = [len(cut) for cut in of_chunks]
    assert max(lengths) - min(lengths) <= 1

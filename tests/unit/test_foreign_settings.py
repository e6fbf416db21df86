"""Files and variables of others that libraries read as they are imported."""

import os

import pytest

from scanplan.errors import StageError
from scanplan.project.run.foreign_settings import check_foreign_settings, keep_figures_ours


@pytest.fixture
def environ(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return {"XDG_CONFIG_HOME": str(tmp_path / "home")}


def test_a_backend_and_a_file_of_the_users_are_not_matplotlibs():
    environ = {"MPLBACKEND": "nonsense", "MATPLOTLIBRC": "mine", "OTHER": "stays"}
    keep_figures_ours(environ)
    assert environ == {"MPLBACKEND": "agg", "MATPLOTLIBRC": os.devnull, "OTHER": "stays"}


def test_files_that_can_be_read_are_let_alone(tmp_path, environ):
    (tmp_path / "matplotlibrc").write_text("savefig.bbox: tight\nno setting\n")
    (tmp_path / "ezdxf.ini").write_text("[core]\ntest_files = x\n")
    check_foreign_settings(environ)


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("matplotlibrc", b"font.size: \xff", "is no text in UTF-8"),
        ("ezdxf.ini", b"\xff\xfe[\x00", "is no text in UTF-8"),
        ("ezdxf.ini", b"words", "is no file of settings (File contains no section headers"),
        ("home/ezdxf/ezdxf.ini", b"[core]\na\n[core]\n", "is no file of settings"),
        ("mine.ini", b"words", "is no file of settings"),
        ("matplotlibrc", None, "is a pipe, expected a file"),
        ("ezdxf.ini", None, "is a pipe, expected a file"),
    ],
)
def test_a_file_that_would_end_an_import_is_told(tmp_path, environ, name, content, said):
    path = tmp_path / name
    path.parent.mkdir(parents=True, exist_ok=True)
    if content is None:
        os.mkfifo(path)
    else:
        path.write_bytes(content)
    with pytest.raises(StageError) as told:
        check_foreign_settings(environ | {"EZDXF_CONFIG_FILE": "mine.ini"})
    assert name in str(told.value) and said in str(told.value)
    assert str(told.value).endswith("move it elsewhere: drawings of ours do not go by it")

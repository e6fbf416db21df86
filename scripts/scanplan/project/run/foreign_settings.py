"""Settings of others that our libraries read while they are imported, whatever they hold."""

import configparser
import os
from collections.abc import Mapping, MutableMapping
from pathlib import Path

from scanplan.errors import StageError
from scanplan.project import user_file

_REMEDY = "move it elsewhere: drawings of ours do not go by it"


def keep_figures_ours(environ: MutableMapping[str, str]) -> None:
    """Let matplotlib begin with a backend that it knows, and with no file of the user's.

    What it reads in the working folder all the same, `stage/figure_files.py` undoes.

    Parameters
    ----------
    environ : dict of str to str
        Of this process, which stages inherit; changed in place.
    """
    environ["MPLBACKEND"] = "agg"
    environ["MATPLOTLIBRC"] = os.devnull


def check_foreign_settings(environ: Mapping[str, str]) -> None:
    """Refuse to begin where a library could not be imported for a file that it reads then.

    Raises
    ------
    StageError
    """
    home = Path(environ.get("XDG_CONFIG_HOME") or "~/.config").expanduser()
    of_ezdxf = ["ezdxf.ini", str(home / "ezdxf/ezdxf.ini"), environ.get("EZDXF_CONFIG_FILE", "")]
    for path in ["matplotlibrc", *filter(None, of_ezdxf)]:
        if user_file.find_file(path, _REMEDY) is None:
            continue
        text = user_file.read_text(path, _REMEDY)
        try:
            if path in of_ezdxf:
                configparser.ConfigParser().read_string(text)
        except configparser.Error as error:
            raise StageError(f"{path}: is no file of settings ({error}); {_REMEDY}") from None

"""What recordings a dataset's tables were made of: a digest that each states, and its poses first.

Tables of another dataset that come to lie among those of one would else be taken for its own.
"""

import json
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from scanplan.errors import StageError
from scanplan.types import FilePath

MADE_OF = "made_of"
"""Under this name a table states the digest among what scanplan says of it."""
_POSES = "poses.parquet"


def read_made_of(path: FilePath) -> str:
    """Return the digest of the recordings that a table was made of; nothing where it says none."""
    try:
        metadata = pq.read_metadata(path).metadata or {}
        return str(json.loads(metadata.get(b"scanplan", b"{}")).get(MADE_OF, ""))
    except (pa.ArrowException, OSError, ValueError, AttributeError):
        # whoever reads its rows says what is wrong
        return ""


def find_made_of(path: FilePath) -> tuple[Path, str]:
    """Return the poses of the dataset that a table belongs to, and the digest that they state.

    The table itself, and nothing, where there are no others.
    """
    path = Path(path)
    # results/<dataset>/plan/corrected/faces.parquet is as deep as any
    places = (folder / _POSES for folder in path.parents[:3])
    poses = next((place for place in places if place.is_file()), path)
    return poses, "" if poses == path else read_made_of(poses)


def check_made_of(path: FilePath, stated: str) -> None:
    """Refuse a table that states other recordings than the poses of its dataset.

    Raises
    ------
    StageError
    """
    poses, made_of = find_made_of(path)
    if made_of and stated not in ("", made_of):
        raise StageError(
            f"{path}: was made of other recordings than {poses} (digest {stated[:12]} instead of"
            f" {made_of[:12]}); delete whichever is not of this dataset and run again"
        )


def check_recordings(poses: FilePath, made_of: str) -> None:
    """Refuse poses that state other recordings than those that a stage is about to read.

    Raises
    ------
    StageError
    """
    stated = read_made_of(poses)
    if made_of and stated not in ("", made_of):
        raise StageError(
            f"{poses}: was made of other recordings, or they have changed since (digest"
            f" {stated[:12]}, now {made_of[:12]}): once nothing writes to them, delete {poses} and"
            " run the same command again"
        )

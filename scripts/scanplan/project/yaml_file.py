"""Files of settings: plain data, read without executing anything."""

import sys
from pathlib import Path

import yaml

from scanplan.errors import StageError


class _Loader(yaml.SafeLoader):
    """Plain data only; a key that is given twice is refused, as its first values would be lost without a word."""

    def construct_mapping(self, node, deep=False):
        pairs = node.value if isinstance(node, yaml.MappingNode) else ()
        keys = [key for key, _ in pairs if isinstance(key, yaml.ScalarNode)]
        values = [key.value for key in keys]
        for i, key in enumerate(keys):
            if key.value in values[:i]:
                raise yaml.constructor.ConstructorError(
                    problem=f"`{key.value}` is given twice, keep one of the two",
                    problem_mark=key.start_mark,
                )
        return super().construct_mapping(node, deep)

    def construct_object(self, node, deep=False):
        try:
            return super().construct_object(node, deep)
        except (ValueError, LookupError, AttributeError):
            # what looks like a date or is tagged as a number, and is none
            raise yaml.constructor.ConstructorError(
                problem=f"`{node.value}` is no {node.tag.rpartition(':')[2]}",
                problem_mark=node.start_mark,
            ) from None


def read_yaml(path):
    """Read a YAML file of settings; plain data only, nothing in it is executed.

    Raises
    ------
    StageError
        If it is no YAML or no mapping, or a key stands in it twice.
    """
    try:
        values = yaml.load(Path(path).read_text(encoding="utf-8"), _Loader) or {}
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f"line {mark.line + 1}, column {mark.column + 1}: " if mark else ""
        raise StageError(
            f"{path}: is not valid YAML ({place}{error.problem or error.context}); mend it"
        ) from None
    except RecursionError:
        raise StageError(f"{path}: is nested too deeply for settings; mend it") from None
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise StageError(
            f"{path}: is not valid YAML ({error}); write it as text, in UTF-8"
        ) from None
    except FileNotFoundError:
        raise StageError(f"{path}: does not exist; name a YAML file with settings") from None
    except OSError as error:
        raise StageError(
            f"{path}: cannot be read ({error.strerror}); it must be a readable file"
        ) from None
    if not isinstance(values, dict):
        raise StageError(
            f"{path}: holds {type(values).__name__}, expected `section: {{key: value}}`"
        )
    return values


def _main(paths):
    """Say of every file whether it can be given as settings of a run; the workflow then checks what it says."""
    for path in paths:
        if not read_yaml(path):
            raise StageError(
                f"{path}: holds no settings; write `section: {{key: value}}`, or leave CONFIG out"
            )


if __name__ == "__main__":
    try:
        _main(sys.argv[1:])
    except StageError as error:
        raise SystemExit(f"scanplan: {error}") from None

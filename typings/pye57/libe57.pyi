import numpy as np

class E57Exception(Exception): ...  # noqa: N818

class Node:
    def __getitem__(self, key: int | str) -> Node: ...
    def reader(self, dbufs: VectorSourceDestBuffer) -> CompressedVectorReader: ...

class ImageFile:
    def __init__(self, fname: str, mode: str) -> None: ...
    def root(self) -> Node: ...
    def close(self) -> None: ...

class CompressedVectorReader:
    def read(self) -> int: ...
    def close(self) -> None: ...

class SourceDestBuffer:
    def __init__(
        self,
        image: ImageFile,
        path: str,
        values: np.ndarray,
        capacity: int,
        convert: bool = ...,
        scale: bool = ...,
        /,
    ) -> None: ...

class VectorSourceDestBuffer:
    def append(self, x: SourceDestBuffer) -> None: ...

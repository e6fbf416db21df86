class _DataConfig:
    min_range: float
    max_range: float

class _MappingConfig:
    voxel_size: float | None

class _RegistrationConfig:
    convergence_criterion: float | None
    max_num_threads: int

class KISSConfig:
    data: _DataConfig
    mapping: _MappingConfig
    registration: _RegistrationConfig
    def __init__(self) -> None: ...

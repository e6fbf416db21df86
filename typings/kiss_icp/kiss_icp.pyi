import numpy as np
from kiss_icp.config import KISSConfig

class KissICP:
    last_pose: np.ndarray
    last_delta: np.ndarray
    def __init__(self, config: KISSConfig) -> None: ...
    def register_frame(
        self, frame: np.ndarray, timestamps: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]: ...

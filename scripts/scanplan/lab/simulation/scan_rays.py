"""The rays of one scan, in the map, and the first opaque surface or person that each meets."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from scanplan.lab.simulation import people, raycast
from scanplan.types import FloatArray, IntArray


@dataclass(frozen=True)
class ScanRays:
    """Rays as columns that start together.

    Attributes
    ----------
    t_s : (c,) float64
        When each column starts, from the start of the drive.
    origin_m : (c, 3) float64
        Where it starts, map frame.
    direction : (c, b, 3) float32
        Unit vectors, map frame.
    """

    t_s: FloatArray
    origin_m: FloatArray
    direction: FloatArray

    def turn_rays(self, ray: IntArray, direction: FloatArray) -> "ScanRays":
        """Return some rays (k,), counted flat, each a column of its own, in directions (k, 3)."""
        column = ray // self.direction.shape[1]
        return ScanRays(self.t_s[column], self.origin_m[column], direction[:, None])


@dataclass(frozen=True)
class Scene:
    """What opaque rays can meet during one scan.

    Attributes
    ----------
    mesh : raycast.RayScene
    people : sequence of people.Person
        Those that do not stand at the sensor.
    """

    mesh: raycast.RayScene
    people: Sequence[people.Person]

    def meet(self, rays: ScanRays) -> tuple[raycast.RayHits, raycast.MeshHits]:
        """Return the first opaque surface or person of rays, flat, and the mesh's surface alone."""
        opaque = self.mesh.opaque_hits(rays.origin_m, rays.direction)
        return self.merge_people(rays, opaque), opaque

    def merge_people(self, rays: ScanRays, hits: raycast.RayHits) -> raycast.RayHits:
        """Return the nearer of a hit and a person for each ray, flat."""
        if not self.people:
            return hits
        met = people.find_person_hits(self.people, rays.t_s, rays.origin_m, rays.direction)
        return people.merge_hits(hits, met)


def unit_rays(direction: FloatArray) -> FloatArray:
    """Return vectors (k, 3) as float32 unit vectors."""
    return (direction / np.linalg.norm(direction, axis=1, keepdims=True)).astype(np.float32)

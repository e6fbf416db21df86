"""Drive a rover through a drawn building and record what its sensors would."""

from pathlib import Path

import numpy as np

from scanplan import atomic, raycast, rover, stagelog, surveybag
from scanplan import building as buildings
from scanplan import truth as ground_truth


def simulate_survey(
    building,
    bag,
    truth,
    true_poses,
    *,
    seed,
    sensor_height_m,
    mount_forward_m,
    mount_yaw_deg,
    n_azimuth,
    scan_rate_hz,
    speed_m_s,
    turn_rate_deg_s,
    range_noise_m,
    max_range_m,
    pose_noise_m,
    pose_noise_deg,
    update_distance_m,
    update_angle_deg,
    route="given",
    clearance_m=0.3,
    **reading,
):
    """Write the recording of a drive (ROS1 bag), the floor's truth (GeoJSON) and the sensor's true poses (TUM)."""
    site = buildings.load(Path(building).read_bytes(), Path(building), slice_height_m=sensor_height_m, **reading)
    reach_m = abs(mount_forward_m)
    site = buildings.routed(site, building, route=route, clearance_m=clearance_m, reach_m=reach_m)
    for note in site.notes:
        stagelog.say(f"simulate_survey: {note}")
    drive = rover.drive(site.waypoints_m, speed_m_s=speed_m_s, turn_rate_rad_s=np.radians(turn_rate_deg_s))
    base_from_sensor = rover.planar_poses([[mount_forward_m, 0.0]], np.radians([mount_yaw_deg]), sensor_height_m)[0]
    scan_ns, tick_ns = rover.scan_stamps(drive, scan_rate_hz), rover.tick_stamps(drive)
    world_from_sensor, world_from_base = rover.poses(drive, scan_ns) @ base_from_sensor, rover.poses(drive, tick_ns)
    noise = {"noise_m": pose_noise_m, "noise_rad": np.radians(pose_noise_deg)}
    limits = {"update_distance_m": update_distance_m, "update_angle_rad": np.radians(update_angle_deg)}
    tick, believed = rover.localise(world_from_base, **noise, **limits, seed=seed)
    lidar = raycast.vlp16(n_azimuth=n_azimuth, max_range_m=max_range_m, range_noise_m=range_noise_m)
    scans = raycast.survey(site.mesh, lidar, world_from_sensor, seed=seed)
    stamps, ticks = surveybag.EPOCH_NS + scan_ns, surveybag.EPOCH_NS + tick_ns
    surveybag.write(
        bag,
        surveybag.mounting(ticks[0], base_from_sensor),
        surveybag.clouds(stamps, stagelog.progress(scans, "simulate_survey", total=len(stamps))),
        surveybag.localiser_poses(ticks[tick], believed, **noise),
        surveybag.odometry(ticks, rover.odometry(world_from_base, seed=seed)),
    )
    atomic.write_text(truth, ground_truth.feature_collection(site.truth))
    atomic.write_text(true_poses, ground_truth.tum(stamps, world_from_sensor))


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        made, settings = snakemake.output, snakemake.params.settings
        simulate_survey(snakemake.input.building, made.bag, made.truth, made.true_poses, **settings)

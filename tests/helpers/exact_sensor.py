"""Settings of `simulate.errors` for a sensor that makes none."""

EXACT = {
    "noise_m": 0.0,
    "bias_m": 0.0,
    "quantum_m": 0.0,
    "grazing_from_deg": 90.0,
    "glass_pass": 1.0,
    "glass_drop": 0.0,
    "glass_return_deg": 90.0,
    "glass_mirror": 0.0,
    "polished_from_deg": 90.0,
    "bias_intensity_m": 0.0,
    "bias_incidence_m": 0.0,
    "mixed_deg": 0.0,
    "stray_share": 0.0,
}

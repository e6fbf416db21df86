"""Settings of `simulate.errors` for a sensor that makes none."""

EXACT = {
    "noise_m": 0.0,
    "bias_m": 0.0,
    "quantum_m": 0.0,
    "grazing_from_deg": 90.0,
    "glass_pass": 1.0,
    "glass_drop": 0.0,
}

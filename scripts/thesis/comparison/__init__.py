"""How good the walls of chosen scans are, by ordering and extractor: measures and figures."""

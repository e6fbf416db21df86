"""How good a plan is in the terms of the field: each measure with its source, each error marked."""

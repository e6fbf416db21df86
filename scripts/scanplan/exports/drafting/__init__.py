"""The regular plan: walls straight and square as far as what is measured of them allows."""

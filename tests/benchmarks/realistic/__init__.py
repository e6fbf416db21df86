"""Plans of realistic buildings and real floors, against what is true of them."""

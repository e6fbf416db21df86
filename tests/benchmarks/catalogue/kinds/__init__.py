"""One module for each kind of building; each draws one with `draw(plan)`."""

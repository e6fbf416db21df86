"""Tables and temporary files between the stages, written whole or not at all."""

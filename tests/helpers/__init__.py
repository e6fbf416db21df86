"""Makers of toy inputs and other things that several tests share."""

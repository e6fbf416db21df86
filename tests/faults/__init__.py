"""Faults on purpose: every case ends soundly, told, or in one clear line, and never in silence."""

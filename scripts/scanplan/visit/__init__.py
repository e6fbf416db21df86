"""Planning of a second visit: questions and standpoints."""

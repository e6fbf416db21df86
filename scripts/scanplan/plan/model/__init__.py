"""What surfaces are, by one likelihood of all that rays say of them: labels along their lines."""

"""What people say of a plan, carried out on its tables."""

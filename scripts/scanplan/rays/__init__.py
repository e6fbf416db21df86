"""What the rays of one scan or many say of the surfaces and the space that they met."""

"""What is whole of damaged recordings: messages found without the index, and what is lost."""

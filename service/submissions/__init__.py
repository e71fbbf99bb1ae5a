"""What is sent, checked before it is stored or decoded."""

"""What is shown: tables, pictures, files, and where they go."""

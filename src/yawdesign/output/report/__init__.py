"""The page that is handed in at a design review: a design review as one HTML file that needs nothing but itself."""

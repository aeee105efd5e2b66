"""Names, numbers and homes of data. Behind it each datum has its name or its number, and nothing unused is left."""

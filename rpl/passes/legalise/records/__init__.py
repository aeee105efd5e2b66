"""What places, texts and data are made of. Behind it a record is one that the target has, or its parts are data of
their own."""

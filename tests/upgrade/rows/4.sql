-- Rules that no program has any more: January is closed again.
INSERT INTO closing (meter, rules) VALUES (0, '00000000deadbeef');

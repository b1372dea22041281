INSERT INTO cursor (destination, position, sum) VALUES ('https://hooks.example.org/recald', 2,
  row_sum('cursor', 'https://hooks.example.org/recald', 2));

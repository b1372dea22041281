INSERT INTO outbox (number, meter, t_start, month, revision, sum) VALUES (1, 0, 1704067200, NULL, 0,
  row_sum('outbox', 0, 1704067200, NULL, 0));

-- Hourly readings of a meter, 1 January to 9 February 2024 (UTC): 40 and 60 kW in turn, so 1200 kWh a day.
INSERT INTO meter (number, id, interval_s) VALUES (0, 'main', 3600);

WITH RECURSIVE hour(i) AS (SELECT 0 UNION ALL SELECT i + 1 FROM hour WHERE i < 959)
INSERT INTO interval (meter, t_start, revision, mean_kW, validity, late, reasons)
SELECT 0, 1704067200 + 3600 * i, 0, 40.0 + 20.0 * (i % 2), 0, 0, 0 FROM hour;

WITH RECURSIVE day(i) AS (SELECT 0 UNION ALL SELECT i + 1 FROM day WHERE i < 40)
INSERT INTO sample (meter, t, field, value)
SELECT 0, 1704067200 + 86400 * i, 'energy', 1000.0 + 1200.0 * i FROM day;

INSERT INTO register (meter, field, state) VALUES (0, 'energy',
  '{"counter":{"baseline":{"kWh":49000,"time":1707523200},"phase":"run","restarts":[1704067200]},"field":"energy","identity":"0047","modulus_kWh":null,"next":1707523200,"pieces":[],"rated_kW":400,"resolution_kWh":0.001}');

-- January as it was closed, and December, which has no readings.
INSERT INTO month (meter, month, revision, closed_at, tzdata, daily_average_kWh, daily_average_variance,
    peak_kW, peak_at, peak_could_be_exceeded, peak_window_s, coverage, filled_share,
    slots_ok, slots_missing, slots_filled, slots_scaled, slots_suspect, slots, unusable_because, reasons)
VALUES
  (0, '2023-12', 0, 1704326400, '2023c', NULL, NULL, NULL, NULL, NULL, 3600, 0.0, 0.0,
    0, 744, 0, 0, 0, 744, 'no readings', 0),
  (0, '2024-01', 0, 1707004800, '2023d', 1200.0, 0.0, 60.0, 1704070800, 0, 3600, 1.0, 0.0,
    744, 0, 0, 0, 0, 744, NULL, 0);
INSERT INTO reopened (meter, month) VALUES (0, '2024-01');

INSERT INTO event (number, t, severity, kind, subject, text) VALUES
  (1, 1704067200, 0, 'started', '', 'recald was started'),
  (2, 1705000000, 1, 'counter_reset', 'main', 'the counter of main was reset'),
  (3, 1706000000, 2, 'store_refused', '', 'the disk is full');

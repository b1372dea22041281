INSERT INTO forecast (number, output, month, revision, model_version, data_revision, made, mean, sd, q05, q50, q95,
    measured, pit, standardised, log_score, crps)
VALUES (1, 'main_daily_kWh', '2024-01', 0, 'a1b2', 'c3d4', 1707004900, 1180.5, 40.25, 1114.0, 1180.0, 1246.5,
    1200.0, 0.69, 0.48, -4.7, 12.125);

UPDATE event SET count = 3, last = 1706003600 WHERE number = 3;
UPDATE job SET tries = 2 WHERE number = 1;

-- From here on rows carry checksums.
UPDATE meter SET sum = row_sum('meter', number, id, interval_s);
UPDATE edit SET sum = row_sum('edit', t, author, reason, file, sha256);
UPDATE interval SET sum = row_sum('interval', meter, t_start, revision, mean_kW, validity, late, reasons, edit);
UPDATE register SET sum = row_sum('register', meter, field, state);
UPDATE sample SET sum = row_sum('sample', meter, t, field, value);
UPDATE month SET sum = row_sum('month', meter, month, revision, closed_at, tzdata, daily_average_kWh,
  daily_average_variance, peak_kW, peak_at, peak_could_be_exceeded, peak_window_s, coverage, filled_share,
  slots_ok, slots_missing, slots_filled, slots_scaled, slots_suspect, slots, unusable_because, reasons);
UPDATE event SET sum = row_sum('event', t, severity, kind, subject, text, count, last);
UPDATE job SET sum = row_sum('job', kind, state, asked_by, asked, started, ended, accepted, message, folder,
  result, tries);
UPDATE forecast SET sum = row_sum('forecast', output, month, revision, model_version, data_revision, made, mean,
  sd, q05, q50, q95, measured, pit, standardised, log_score, crps);

INSERT INTO job (number, kind, state, asked_by, asked, started, ended, accepted, message, folder, result) VALUES
  (1, 0, 3, 'month', 1707004800, 1707004801, 1707004900, 0, 'the chains do not agree', 'calibration-1', ''),
  (2, 1, 4, 'api', 1707005000, NULL, 1707005100, 0, 'an earlier request is still waiting', '', '');

-- An hour of February that a person corrected: 99 kW.
INSERT INTO edit (number, t, author, reason, file, sha256) VALUES
  (1, 1707300000, 'operator', 'read off the display', 'logger.csv',
    '9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08');
INSERT INTO interval (meter, t_start, revision, mean_kW, validity, late, reasons, edit) VALUES
  (0, 1707177600, 1, 99.0, 0, 1, 0, 1);

"""Files of reported values and force records that are refused, and the messages."""

HEADER = "quantity,time_s,value,unit,source\n"
ROWS = HEADER + "mean_velocity,4,8,m/s,x\n"
KINDS = "quantity,time_s,value,unit,kind\n"
ALLOWED_KINDS = "for mean_velocity; allowed: observation, model, assumption"
NO_TIME = "give one column of times, time_s, time_min, time_h; "
# Contents, and words of the message.
INVALID = [
    (b"", ": empty; expected the columns quantity, value, unit"),
    (b"# only this\n", ": empty; expected the columns quantity, value, unit"),
    ("quantity,time_s,value\na,1,2\n", ":1: no column unit; found 'quantity', 'time_s', 'value'"),
    ("quantity;unit\na;m\n", "found 'quantity;unit'. Columns are parted by commas: write , in place of ;"),
    ("quantity,value,unit\nmean_velocity,1,m/s\n", f":1: {NO_TIME}found none"),
    ("quantity,time_s,time_h,value,unit\n", f":1: {NO_TIME}"),
    ("quantity,time_s,value,unit,sorce\n",
     ":1: no column is called 'sorce'; did you mean source? allowed are quantity, value, unit, "),
    ("quantity,time_s,value,unit,unit\n", ":1: two columns 'unit'"),
    (HEADER + "qqq,4,8,m/s,x\n", ":2: no quantity is called 'qqq'. There are: "),
    ("# x\n" + HEADER + "mean_displacement,4,8,ft,x\n", ":3: the unit 'ft' for mean_displacement; allowed: m, km, cm"),
    (HEADER + "mean_velocity,4,8\n", ":2: 3 values for 5 columns"),
    (ROWS + "mean_velocity,4,9,m/s,x\n",
     ":3: mean_velocity at this time from this source is in line 2 already; keep one of the two"),
    (KINDS + "mean_velocity,4,8,m/s,guess\n", f":2: the kind 'guess' {ALLOWED_KINDS}"),
    (KINDS + "mean_velocity,4,8,m/s,\n", f":2: no kind {ALLOWED_KINDS}"),
    (HEADER.encode() + b"mean_velocity,4,8,m/s,M\xfcller\n", ":2: byte 0xfc is not UTF-8"),
    (HEADER.encode("utf-16"), ": encoded as UTF-16; save it as UTF-8"),
    (b"x" * (1024 * 1024 + 1), ": too large (allowed 1 MB)"),
    (HEADER + "start_velocity,4,8,m/s,x\nstart_velocity,5,8,m/s,y\n",
     ":3: start_velocity is in line 2 already; one row sets the clock"),
]  # fmt: skip
# The second line of a file, and words of the message.
INVALID_ROWS = [
    ("mean_velocty,4,8,m/s,x", "no quantity is called 'mean_velocty'; did you mean mean_velocity? There are: "),
    ("max_seismic_force_35_s,4,8,N,x", "no quantity is called 'max_seismic_force_35_s'"),
    ("mean_displacement,4,8,,x", "no unit for mean_displacement; allowed: m, km, cm"),
    ("mean_velocity,4,8,m,x", "the unit 'm' for mean_velocity; allowed: m/s, km/h"),
    ("mean_velocity,4,nan,m/s,x", "expected a finite number, found 'nan'"),
    ("mean_velocity,inf,1,m/s,x", "expected a finite number, found 'inf'"),
    ("mean_velocity,4,fast,m/s,x", "expected a number, found 'fast'"),
    ('mean_velocity,4,"0,6",m/s,x', "expected a number, found '0,6'; write the decimals behind a point"),
    ("mean_velocity,4,1_0,m/s,x", "expected a number, found '1_0'"),
    ("mean_displacement,4,1e308,km,x", "mean_displacement: a number that large cannot"),
    ("mean_velocity,4,-8,m/s,x", "mean_velocity is -8 m/s; allowed: at least 0 m/s"),
    ("band_SL,4,30,-,x", "band_SL is 30; allowed: at least 0, at most 1"),
    ("band_SL,4,130,%,x", "band_SL is 130 %; allowed: at least 0, at most 1"),  # in the first unit
    ("band_temperature,4,-5,K,x", "band_temperature is -5 K; allowed: at least -273.15 C"),
    ('mean_velocity,4,8,m/s,"x', "not a row of comma-separated cells: "),
    ("mean_velocity,4,8,m/s,\0", "a zero byte; this is not a text file"),
]
WRONG_TARGETS = [*INVALID, *((f"{HEADER}{row}\n", f":2: {message}") for row, message in INVALID_ROWS)]

FORCES = "time_s,up_N,north_N,east_N\n"
FORCE_RANGE = FORCES.rstrip() + ",up_low_N,up_high_N,north_low_N,north_high_N,east_low_N,east_high_N\n"
ALL = "up_low_N, up_high_N, north_low_N, north_high_N, east_low_N, east_high_N"
TOO_FEW = "too few rows (found {}; allowed: 2 or more). Add the history."
# Contents, and the message after the name of the file.
WRONG_FORCES = [
    ("", ": empty; expected the columns time_s, up_N, north_N, east_N"),
    ("time_s,up_N,north_N\n", ":1: no column east_N; found 'time_s', 'up_N', 'north_N'"),
    (FORCES, f": {TOO_FEW.format(0)}"),
    (FORCES + "0,0,0,0\n", f": {TOO_FEW.format(1)}"),
    (FORCES + "0,0,x,0\n1,0,0,0\n", ":2: expected a number, found 'x'"),
    (FORCES + "0,0,inf,0\n1,0,0,0\n", ":2: expected a finite number, found 'inf'"),
    (FORCES + "0,0,0\n1,0,0,0\n", ":2: 3 values for 4 columns"),
    (FORCES + "0,0,0,0\n1,0,0,0\n1.0,0,0,0\n",
     ":4: time_s does not rise (found 1.0 after 1; allowed: more than that). Sort the rows by time."),
    (FORCES.rstrip() + ",up_low_N\n0,0,0,0,0\n1,0,0,0,0\n",
     f":1: the range is not complete (found no {ALL.removeprefix('up_low_N, ')}; allowed: all of {ALL}, or "
     "none). Add what is missing."),
    (FORCE_RANGE + "0,0,0,0,-1,1,-1,1,-1,1\n1,0,2,0,-1,1,-1,1,-1,1\n",
     ":3: north_N is outside its range (found 2; allowed: -1 to 1). Correct one of the three."),
]  # fmt: skip

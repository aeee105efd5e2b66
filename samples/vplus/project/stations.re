.REALS
station.count 3
put.down 0
.END
.STRINGS
$station "bench"
.END

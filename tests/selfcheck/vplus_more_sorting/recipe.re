.REALS
order[0] 1
order[1] 2
order[2] 1
order[3] 3
order[4] 9
order[5] 2
order[6] 1
order[7] 4
order[8] 2
order.len 9
cap[1] 2
cap[2] 2
cap[3] 4
pitch.x 50
pitch.y 40
bead.r 30
.END

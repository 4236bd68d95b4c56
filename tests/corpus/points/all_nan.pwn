4
0 0 0 nan 0 0
1 0 0 nan 0 0
0 1 0 nan 0 0
0 0 1 nan 0 0

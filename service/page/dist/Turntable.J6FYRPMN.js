import{a,b,c}from"/page/chunk.GO34WTX4.js";import"/page/chunk.AL4O2LQE.js";import"/page/chunk.F5XGFZ2T.js";export{b as SIDES,a as TURNED_FOV_DEG,c as Turntable};

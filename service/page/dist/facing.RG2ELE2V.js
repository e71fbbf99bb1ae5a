import{a}from"/page/chunk.KBZNATXQ.js";import"/page/chunk.AL4O2LQE.js";import"/page/chunk.F5XGFZ2T.js";export{a as facingOf};

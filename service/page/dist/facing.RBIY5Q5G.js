import{a}from"/page/chunk.HMJ2MS2C.js";import"/page/chunk.64GWOZLD.js";import"/page/chunk.F5XGFZ2T.js";export{a as facingOf};

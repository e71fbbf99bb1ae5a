import{a,b,c}from"/page/chunk.UEXDQ7EF.js";import"/page/chunk.64GWOZLD.js";import"/page/chunk.F5XGFZ2T.js";export{b as SIDES,a as TURNED_FOV_DEG,c as Turntable};

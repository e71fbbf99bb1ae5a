import{a,b,c}from"/page/chunk.BWMDJBGR.js";import"/page/chunk.6DVJNGJI.js";import"/page/chunk.F5XGFZ2T.js";export{b as SIDES,a as TURNED_FOV_DEG,c as Turntable};

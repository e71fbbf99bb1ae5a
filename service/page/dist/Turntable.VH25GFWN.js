import{a,b,c}from"/page/chunk.ZIKKCLI4.js";import"/page/chunk.DKD75HTU.js";import"/page/chunk.F5XGFZ2T.js";export{b as SIDES,a as TURNED_FOV_DEG,c as Turntable};

import{a}from"/page/chunk.DFBLRF4J.js";import"/page/chunk.DKD75HTU.js";import"/page/chunk.F5XGFZ2T.js";export{a as facingOf};

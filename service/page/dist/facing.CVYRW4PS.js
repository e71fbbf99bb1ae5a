import{a}from"/page/chunk.UAUZ2ZNI.js";import"/page/chunk.6DVJNGJI.js";import"/page/chunk.F5XGFZ2T.js";export{a as facingOf};

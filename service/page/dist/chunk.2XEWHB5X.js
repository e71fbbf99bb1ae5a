import{k as n}from"/page/chunk.36TC3BWD.js";var t=n("");function i(o){t.value=o}export{t as a,i as b};

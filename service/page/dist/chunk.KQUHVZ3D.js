import{k as n}from"/page/chunk.PJCD6TXW.js";var t=n("");function i(o){t.value=o}export{t as a,i as b};

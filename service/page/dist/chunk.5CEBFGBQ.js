import{k as n}from"/page/chunk.UTCU72ZA.js";var t=n("");function i(o){t.value=o}export{t as a,i as b};

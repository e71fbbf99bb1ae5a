import{k as n}from"/page/chunk.HM6OPBQ3.js";var t=n("");function i(o){t.value=o}export{t as a,i as b};

import{k as n}from"/page/chunk.DHSW2F7S.js";var t=n("");function i(o){t.value=o}export{t as a,i as b};

import{k as n}from"/page/chunk.WPAG6OT3.js";var t=n("");function i(o){t.value=o}export{t as a,i as b};

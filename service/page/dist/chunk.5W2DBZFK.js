import{k as n}from"/page/chunk.VMHAF6WP.js";var t=n("");function i(o){t.value=o}export{t as a,i as b};

"""A matrix of thresholds without a pattern: neighbors differ much, and no direction or period stands out.

R. Ulichney, "The void-and-cluster method for dither array generation", Proc. SPIE 1913 (1993), 332-343.
tests/raster/void_and_cluster.py finds it anew: stored, it costs a small Pi nothing, and is the same on all machines.
"""

from __future__ import annotations

import base64

import numpy as np
from numpy.typing import NDArray

_SIDE = 64


def thresholds() -> NDArray[np.uint8]:
    """Return 0 ... 255, each 16 times, of shape (64, 64)."""
    return np.frombuffer(base64.b85decode(_TEXT), np.uint8).reshape(_SIDE, _SIDE)


_TEXT = (
    "u`|f=W#V}L8I9~DS)(Y-bKW8D2);dz(SPPKWKPWN7Qa?0qS=BntB=QG3cWO_QXrWJqjEeA$!Z~iSdmE{?pJ&%vpv8qY_2wT_zUHeH@afWnR(kQ"
    "PH4FT@SZM>r#0Mi$UbS~Ru1cY+K^x1h;HmQ*CV#~enr5oHsZW$1&q=cpIQ)@-BZGrMz@1f^bUnGQXOIPrx%sabQ|7iPyGS1826eKzi%z0A4AF#"
    "EX7HFz=~6qE#wN<a1<|}ORqcma?R<3K?m0w-!p0$uSuf**SLfX#6bO5HnD>Z(s!6$hAU0fi1kRhSo3t1`KcA;VhZXSsbh{%oA!m<C*)j_223ir"
    "^QUo!U!~9Kd&VVj0YseXZHyv)$4vIUKOf3Q?Yd^IISH5MgaxcUWl)eRtU}6k)j;zm%{yMlfNdPX+^BnH6Id|3{Q@hNJYdt1t>7b4GuN)<3XvpW"
    "pMv2rod?|`ddy%M)ilBB4%ohL@SR#PyAyz=19hnpzn$?fg+2Tsp33ANM2%Iz3icUPIBLm%yarxEq-@_c?z9YH!gG>V{-8j1rc`ewn|w6^(H@8X"
    "mu%u%z~)B&Rs=?{Uktp}f=82ev+Zl%c$~K6i1`$x@N}5?9@4FS7D;gRBRuC3xGdqtANz{iMY8%-e?7zqP${uDh#HeI(2Ch`>y}PxHS!W#(-t+a"
    "AVFs<39?`>NEpg8gh~%s$(7foiO;J_hHL?mOScGK$s1_km9=N(q1g=iPSa|$cPOG2z$)Xk1);$!rG1-F#_EB>+fA0zh~ZJWWa_+&{v9z<1YCF>"
    "@xfc|c{=5!FNUfQEc6<BGKI%;o+|GX<6!zfScw^X*kOhHLEi-Tiw#(wJb3K_XRacV1)wQDWwL|mzWOuPoH?l{*O?e{_EFVApkGMMu3kkMzFDV2"
    "k_)nV%<ZX4FzQYZaJFABan>dK5vwQ0KK*;v@N&fG2+%@p6_>JR3R24vWwc1pl>@qa-oTFp_9Eel=>dDdQphcu12t{NmLILkk0Q;Lu1UU&Z`fRo"
    "rVdy!NE}<2d7~oVhfE=U;gI)&H1dfiWjXI_5-8|zJejp*J(&10;BD|r)?EA%fYf9(=TP%J742j;v`F(6bi$a-tBKSvN%vj4G|uq3K_zRW##j))"
    "<*gl^PlTsc*m@1iC(~&bi>MlcxR55JKk)&ad<|~AfuING9GWiDP3|OO`4hL{4#kcEp>Yshn$rVHAl-DJN`YR~`!~uIuPyykqJ&4dC0IS;4|CqW"
    "S#q~T#irUIRLOVHUA=;4usDYTa6)@kr)oRvR^qBL{dv6Vtdc(d49P3A29#p&M~`Z~8uAI*a{j_(pgK+n<tvT;Bw;v``amU-JpTma8l2p@=$aq#"
    "h$zl}9Yu-B8B;caWeCzPY?$Fdb;BQj&jRE=e6mrR&H{`p^3JY(n$Q<j)P?2*sblQ16L6+P%6C^rE~?T#!4dznnb-zrw3gc@_ei;Z>P{GqSLmWM"
    "xK^9lEoJL9wM(ma7g{6vIAgDR3b#se!4-c@-ojLlEcgw?fM*9=mUK#CEq3!d=Wz|9$Bkbep1^4Mtqx3V^(cZ8$fX{E66rVHmbz<;48ra~q4h1A"
    "<2KZuFNYxPv0{|g8v3*9FxspO(Y{oSAx6JfITr7)I|0u&B;3c93asdDO^nrDoNUHX3GPMTqfaT19B0lMRgGu{_g~csbUh=aQH?@updfwmL7fw@"
    ")tmK%-EqxNhUIplh-N){(qBEj@&!QoE{Y$gdoIZqf6#Ke*-Wo@{Iw;>twVjD+`I2<;491!<5k9vBy0RNb^v7}rU#NLyj~qj>b)5LEsz$SDz0_A"
    "<45;n+L5kYI^_sm@-UMDI@nHikQvM{RuD&n0l0RkhdTpe=D34f$m}w=Mf_&h5csOh3s{}CQsm2HfZ$gYe98p3IU8>NnI@@<6>i4ogPauTGxD-$"
    "{g276H}YB>{Ic1YMh)C0rA?FJfWkANdP9&eeegGh0dq$A3N_KCCYo7?@K3t{#!~D*&Y?tFA!E&_ZBho9CUh3rP?OX}XeW2XFsf0F62EW^UL8{5"
    "wjp5MvS}gUznLPd!;(sAzdq^`rFY;$g>1GRdiM~#rS3)zzlGw&Lgu4pBY6tLoaz)?_;StgKIJOauJV)!YU{@ZNTSL_VeUGHS>zA@8Q60%%pa61"
    "^ADEYU?`2>G<c6H+B_h5tywkso8qi6flsiD2b&yYexOy0J#NrNj53>m^b>ZH53tu4a4fWbt6`J6Ok~!vUd}O2!>&he2*>|am#JX&57UPQ#6Vm1"
    "8QeU|;X}YIwFCUc5vMD_|5F^gSvJx9E__g<_S2bD@+k%4g!>G9NvMkb1Agz+SFsyt<^az}l_;}IZxo2la-nA_epU02)=YLKW9fw#b*a{E;-($6"
    "T<8SBJ7NezhR3Hv9G*JFAK4XhqB$IxDu+YFcr}B*Ywmp4^rt7eH~{~<7p-UyJLj6S*GHaQ;{Zb_k4kTfK**bdA&$7-H*{I=Z@5?KhG{?GR?D_z"
    "=FOiKulOOM6IV1FkYVUglGRv?<}=ZRsa_N{fd}z8yN1a46Tk5b+$3sC>&|Z)pV|(?E#Lx_F7U084E2LX1#>d&OJ3JM<HVe|LkH1y9kV_VbC*o|"
    "C&zO4y;#d1W~5PhpJ6VjcDniztTI^qM<j!pOnR$g%ugG{Gi?{E^IO%02$QUJi3DZoe!(xI^kC|!%p$uBdfq~iBdB_m-YyO6I>+Zzk~Ux1c$f^b"
    "&}jCs8PPxa5W0Y0)Slirz?LJnZ^$eb{YlRuR{4oZ34kYQNbh8!QM3eR=1UIxL$}adlLvnu(gL7EA;aZ<0F*FY>WU<tb1I_yNFR$;eGN|IJM>oC"
    "Y_pCztP*Lp-^H5T1CKh@g){G+!!pxv7mIfyvfWC&_HMK7j$<}azv4v23v0bm;m|t^c)af^%>Jonj1Rq+F&gZ7+?LKZ9#uN7e8C>}63=lPS%<S+"
    "qu@;bY%!){J%%e&(-!oif*W?C**ftAi(|Bu*<=8qaXJ*yD5Xbw&0MAlO(t9Lcai-SQR!=|S(HVv-wO03$TtGOjuY>f4&c2Cd#Z0ITl}{rSebdM"
    "L>lE(Bd|c|Tf3Qf>|x*m_Cj&V`?7+g5xZi_D40QjEWiIJc|Vs<f9{-JKhbq2%~_oPN5MPVs1Qz%?ij-<|HgbY^^Vhl8{bhewjGG7CcK#!WIO`V"
    "Narzi+_etO<p7Fh#-!9|7O`(3>Z(e&gF0*;jN}HBL+EkOHfr5XXPO7Aa1l=~!;A&^S<5_T+kZ6WhraD?BZQ{~i&yhzJfcq+>@Wu7jWX85g$8K("
    "738qdE>ddChcCJVfU^vcyE*LGUC5~WXhE)gpAY7gQwhsYrYTgBwB1hmH=!Pex^mRBkXd%NN%#y_JC)inp;85Zr0lp9TG*XR`l4L#8-YwEl013~"
    "m+2YWM{c?y|Fdfx_jcMAIAs&PZpcj7FA?Y|MEk@do@0Hb?IXxxi^cXvV;Ot-uo!3JB}2$EZqlT^6YkI|x>e04k?%EqM4Q%$LI|G0_L$RvBkT#O"
    "_nBaRsT7Gj=g1zsY)!EjJ#Q(r+c=*naXpd2b`^u(nE_zrb5fjShc|VmTm#am6<sgus?T9ZbShM+M3ZBDRX)E3&THOW1CT}A5B+%Krt6XpgvCqW"
    "zV!%Eob#+sDEvW*Ft7;Q@ejrNK)!}%^27^zS0an$4!QCI+PNpr72%BaP?#mKboDENpfZjDS{~6=^l1W<A%4y>)?Nw2eYvL^#rR1js!p00Z{#RV"
    "+>EX~zTPyfe?X33bvgWpuP$vLIq1Mg(w$VfVaiC@xOzUNEU)WaM5Sc0Ad5ikXAV}|c3+UfX@TJ|jjs`)I3R5NlmKJ+8`;Gm<D?B}NY<dZf?x@V"
    "Ga2Oy^B=8lF8arf7kD+&iRcphaNM6S(3SKopA<RQ0Y156&sF$!yI9Q>O?k_hP-&brgjC6u?FU!#7}cZuWvX(IIDG38olFO0+r5_yw^cTTM!gn!"
    "O&*0r$>*$a|D7Q53qOU}1n+{L=C(m6yawvA6Y)VJzITp5#Bxm_x!Xd)*-({Y-h#2|Qb7J`Db}6J0$Spx?!vHZ34l&3iB-yYleQvZr9~!XG#K%Q"
    "-giD(&UCb8G}9ETERyXweE?b{r3T9+zBe0nCa4zSlye-c?vXlY1~gsPmhv69<qfVcP3gupk-_4u*mI;@9H;(_DVPA?p;G>5;tgKHndplDXoNrX"
    "SEKOJk;j2e2=qi_dnC2egPZ&$JHBLj&qHk7q6cmL8Fva(jt@xEH^&cY*hcqy9EY_@fz7BEOUp2?7~ryV35P{y09!N8UA)~d%}@0kRL2l|SKS1p"
    "F_!rjT8OJl(OvX7%(VH6ahXuN9jjWzJnJU|nlE+uY94n-$6GF!*1|2Z+@JQXDuNJ<un3iO=|r*Qp@>HHT^zc7%RAyIgSeC(dtxa9=`7)X?J|iA"
    "rf<`{=u_1`w%?)dj}Z4tA8Ps%d_Ed=>r0~gXxlidC68+|7||!Of7wbb>=D151V7oR<3YurWwb&EpKjFgPn2CbeHxz*j#dgeX{vp>-=R~I=1|a<"
    "w$?aSA%VVI*8#-$Pq=OC3zBKAmtc2L@op<t361Sg8q$qi%S#lsBjXdQ`e?)OEql+nCe=G(4TCwiC&6R{Y#VvA=SLF#aY3G6f)AKdIl|`vLHi=q"
    "q{)Z>yKyzEe*7k>^edHVfi%mENF;<>tL90D@&%UYD#q^^ag6^n-;&7<i_V)ZhP3A(+Q2Z>q*^0-%Cd?#4qh2Wp(5A}!#;8qd%xX6{kviX+P6T<"
    "18p6nS#-lmscu%)tq?_~R4nvhG;8fq#tb)-M05Xz6Yz}NQ4?m|xs&U|e_QiulvCcfJ7ET>7?(@xYm^n?n>PE&Ki?OK{05pq=U&Z#2CYe;!vn7%"
    "-(7s|t_5ExwrxG9Et~6kO(kkK1I$9EDDDED*N^X0bJZe%uQK;^Ouc^#ktw!jHqV4CcAOyaYS4Zc=#W5hm8sAgQ^}v?O~ncJV8A~F^{msE=dXzo"
    "yKaVBE*pQvF|zhQ3&viGCfiu7YwDg*zaFRd48l6Kk0kmyb6L;y5J@d<^@=li9h1~|7l_WEGlUROa4c8*H`GJs!lgan3Sfz(RNWl8pb_mb&_)9D"
    "cG_c0*N9i-Lt?$8*(0?xg5$QEKN8)q`dcxz;wMvZ;9tV{9NT-vn;)<eaQj@Ec+VK+aF#{WXFPb08@hunlM*_$ZYrb^+LsJUhzFfd#$N!_fWc=-"
    "1Ez{bXrucMu^&UDinR$vW`FUKOa{9k^Gi9fD*t@|^R&!Q{a)RwROg-W0LcA$"
)

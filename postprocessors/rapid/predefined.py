"""Names that every RAPID system has declared: data, functions, instructions and types (lower case).

A program's own data of such a name hides the system's, so `fine` or `Offs` in a move would mean the program's variable.
The writer gives data of other languages another name then. Sources: reference manual, system data and data types.
"""

from __future__ import annotations

from .tables import words

_DATA = words(
    """aio_above_high aio_above_low aio_always aio_below_high aio_below_low aio_between aio_outside errstr_context
    errstr_empty errstr_task errstr_unused opadd opdiv opmod opmult opsub
    btnabrtrtryign btnnone btnok btnokcancel btnretrycancel btnyesno btnyesnocancel common_err dint diskhome edge
    eof_num eq event_none event_poweron event_qstop event_reset event_restart event_start event_step event_stop
    fine fllwtime fllwtime0_5 fllwtime1_0 gt gteq handler_bwd handler_err handler_none handler_undo hardware_err
    high iconerror iconinfo iconnone iconwarning inpos inpos100 inpos20 inpos50 int io_com_err lint load0
    long_jmp_all_err low lt lteq motion_err noteq op_auto op_man_prog op_man_test op_state op_undef operator_err
    pi process_err program_err resabort rescancel resignore resno resok resretry resunkwn resyes run_cont_cycle
    run_instr_bwd run_instr_fwd run_sim run_undef sint socket_bound socket_closed socket_connected socket_created
    socket_listening stempty stoptime stoptime0_5 stoptime1_0 stoptime1_5 str_digit str_lower str_upper str_white
    system_err tool0 tp_latest tp_program tp_screenviewer type_all type_err type_state type_warn udint uint ulint
    user_def_err usint vmax wait_max wobj0"""
)
_ERRORS = words(
    """err_alrdy_moving err_alrdycnt err_ao_lim err_argdupcnd err_argname err_argnotper err_argnotvar err_argvalerr
    err_axis_act err_axis_ind err_axis_moving err_axis_par err_bwdlimit err_callio_inter err_callproc
    err_cfg_illtype err_cfg_internal err_cfg_limit err_cfg_notfnd err_cfg_outofbounds err_cntnotvar
    err_cnv_connect err_cnv_dropped err_cnv_not_act err_comm_ext err_comm_init err_comm_init_failed err_conc_max
    err_data_recv err_dev_maxtime err_diplag_lim err_divzero err_execphr err_fileacc err_fileexist err_fileopen
    err_filesize err_fncnoret err_frame err_go_lim err_illdim err_illquat err_illraise err_indcnv_order
    err_inoissafe err_inomax err_int_maxval err_int_notval err_invdim err_iodisable err_ioenable err_ioerror
    err_linkref err_loaded err_loadid_fatal err_loadid_retry err_loadno_inuse err_loadno_nouse err_maxintval
    err_mod_notloaded err_module err_msg_pending err_name_invalid err_negarg err_no_aliasio_def err_no_sgun
    err_norununit err_notarr err_noteqdim err_notintval err_notpres err_notsaved err_num_limit err_outofbnd
    err_outside_reach err_overflow err_path err_path_stop err_pathdist err_perssupsearch err_pid_movestop
    err_pid_raise_pp err_prgmemfull err_procsignal_off err_progstop err_ranybin_chk err_ranybin_eof err_rcvdata
    err_refunkdat err_refunkfun err_refunkprc err_refunktrp err_rmq_dim err_rmq_full err_rmq_invalid
    err_rmq_invmsg err_rmq_msgsize err_rmq_name err_rmq_nomsg err_rmq_timeout err_rmq_value err_roblimit
    err_sc_write err_sig_not_valid err_sigsupsearch err_sock_addr_inuse err_sock_closed err_sock_is_bound
    err_sock_is_conn err_sock_net_unreach err_sock_not_bound err_sock_not_conn err_sock_not_def
    err_sock_not_stream err_sock_timeout err_sock_unspec err_speed_refresh_lim err_speedlim_value err_startmove
    err_store_prof err_strtoolng err_sym_access err_syncmoveoff err_syncmoveon err_syntax err_taskname
    err_tp_dibreak err_tp_dobreak err_tp_maxtime err_tp_no_client err_trustlevel err_txtnoexist err_udpuc_comm
    err_ui_buttons err_ui_icon err_ui_initvalue err_ui_maxmin err_ui_notint err_uishow_fatal err_uishow_full
    err_unit_par err_unkino err_unkproc err_unload err_use_profile err_wait_maxtime err_waitsynctask err_whlsearch
    err_wobj_moving"""
)
_SPEEDS_AND_ZONES = words(
    """v10 v100 v1000 v150 v1500 v20 v200 v2000 v2500 v30 v300 v3000 v40 v400 v4000 v5 v50 v500 v5000 v60 v600 v6000
    v7000 v80 v800 vlin10 vlin100 vlin1000 vlin20 vlin200 vlin50 vlin500 vrot1 vrot10 vrot100 vrot2 vrot20 vrot5
    vrot50 z0 z1 z10 z100 z15 z150 z20 z200 z30 z40 z5 z50 z60 z80"""
)
_FUNCTIONS = words(
    """abs absdnum acos acosdnum ainput aoutput argname asin asindnum atan atan2 atan2dnum atandnum bitand bitanddnum
    bitcheck bitcheckdnum bitlsh bitlshdnum bitneg bitnegdnum bitor bitordnum bitrsh bitrshdnum bitxor bitxordnum
    bytetostr calcjointt calcrobt camgetloadedjob camgetname camnumberofresults cdate cjointt clkread corrread cos
    cosdnum cpos crobt cspeedoverride ctime ctool cwobj dectohex defaccframe defdframe
    defframe dim dinput distance
    dnumtonum dnumtostr dotprod doutput eulerzyx eventname eventtype exechandler execlevel exp filesize fssize
    getmecunitname getmodalpayloadmode getmotortorque getnextsym getserviceinfo getsysinfo gettaskname gettaskno
    gettime ginput ginputdnum goutput goutputdnum hextodec indinpos indspeed iounitstate iscyclicbool isfile
    ismechunitactive ispers isstopmoveact isstopstateevent issyncmoveon issysid isvar max maxrobspeed min mirpos
    motionplannerno norient numtodnum numtostr offs opmode orientzyx orobt paridposvalid paridrobvalid
    pathrecvalidbwd pathrecvalidfwd pfrestart poseinv posemult posevect pow powdnum present progmemfree
    rawbyteslen readbin readdir readdnum readmotor readnum readstr readstrbin reltool rmqgetslotname robos round
    rounddnum runmode sin sindnum socketgetstatus socketpeek sqrt sqrtdnum strdigcalc strdigcmp strfind strformat
    strlen strmap strmatch strmemb strorder strpart strtobyte strtodnum strtoval tan tandnum taskrunmec taskrunrob
    testandset testdi testsignread textget texttabfreetouse texttabget triggdatavalid trunc truncdnum uialphaentry
    uiclientexist uidnumentry uidnumtune uilistview uimessagebox uinumentry uinumtune validio valtostr vectmagn"""
)
_INSTRUCTIONS = words(
    """accset actunit add aliasio arcc arccend arccstart arckill arcl arclend arclstart arcrefresh bitclear bitset
    bookerrno break callbyvar camflush camgetparameter camgetresult camloadjob camreqimage camsetexposure
    camsetparameter camsetprogrammode camsetrunmode camstartloadjob camwaitloadjob cancelload checkprogref
    cirpathmode clear cleariobuff clearpath clearrawbytes clkreset clkstart clkstop close closedir confj confl
    contactl copyfile copyrawbytes corrclear corrcon corrdiscon corrwrite deactunit decr dropsensor dropwobj
    egmactjoint egmactmove egmactpose egmgetid egmmovec egmmovel egmreset egmrunjoint egmrunpose egmsetupai
    egmsetupao egmsetupgi egmsetupuc egmstop eoffsoff eoffson eoffsset erasemodule errlog errraise errwrite
    exitcycle fcact fccalib fcdeact fcpress1lstart fcpressc fcpressend fcpressl fcrefstart fcrefstop getdataval
    getsysdata gettrapdata gripload idelete idisable ienable ierror incr indamove indcmove inddmove indreset
    indrmove invertdo iobusstart iodisable ioenable ipers irmqmessage isignalai isignalao isignaldi isignaldo
    isignalgi isignalgo isleep itimer ivarvalue iwatch load makedir manloadidproc mechunitload motionsup moveabsj
    movec movecao movecdo movecgo movecsync moveextj movej movejao movejdo movejgo movejsync movel movelao moveldo
    movelgo movelsync open opendir packdnheader packrawbytes pathacclim pathrecmovebwd pathrecmovefwd pathrecstart
    pathrecstop pathresol pdispoff pdispon pdispset procerrrecovery prxactivrecord pulsedo raisetouser readanybin
    readblock readcfgdata readerrdata readrawbytes readvararr removedir removefile renamefile reset restopath
    rewind rmqemptyqueue rmqfindslot rmqgetmessage rmqgetmsgdata rmqgetmsgheader rmqreadwait rmqsendmessage
    rmqsendwait save scwrite searchc searchextj searchl set setalldataval setao setdatasearch setdataval setdo
    setgo setsysdata singarea skipwarn socketaccept socketbind socketclose socketconnect socketcreate socketlisten
    socketreceive socketreceivefrom socketsend socketsendto softact softdeact speedlimaxis speedlimcheckpoint
    speedrefresh spotj spotl spotmj spotml spystart spystop startload startmove startmoveretry stepbwdpath stop
    stopmove stopmovereset storepath supsyncsensoroff supsyncsensoron syncmoveoff syncmoveon syncmoveresume
    syncmovesuspend syncmoveundo synctosensor systemstopaction testsigndefine testsignreset texttabinstall tperase
    tpreaddnum tpreadfk tpreadnum tpshow tpwrite triggc triggcheckio triggequip triggint triggio triggj triggjios
    triggl trigglios triggrampao triggspeed triggstopproc tryint tunereset tuneservo uimsgbox uimsgwrite
    uimsgwriteabort uishow unload unpackrawbytes velset waitai waitao waitdi waitdo waitgi waitgo waitload waitrob
    waitsensor waitsynctask waittestandset waittime waituntil waitwobj warmstart worldacclim write writeanybin
    writebin writeblock writecfgdata writerawbytes writestrbin writevar writevararr wzboxdef wzcyldef wzdisable
    wzdoset wzenable wzfree wzhomejointdef wzlimjointdef wzlimsup wzsphdef"""
)
_TYPES = words(
    """aiotrigg bool btnres busstate buttondata byte cameradev clock confdata corrdescr dionum dir dnum egmident
    errdomain errnum errtype extjoint handler_type icondata identno intnum iodev iounit_state jointtarget loaddata
    loadidnum loadsession mecunit num opcalc opnum orient paridnum paridvalidnum pos pose rawbytes rmqmessage rmqslot
    robjoint robtarget sensor sensorstate shapedata signalai signalao signaldi signaldo signalgi signalgo
    socketdev socketstatus speeddata speedlimdata string switch switchtype symnum syncident taskid tooldata tpnum
    trapdata triggdata triggios triggiosdnum triggmode triggstrgo tunetype wobjdata wzstationary wztemporary
    zonedata"""
)

PREDEFINED = _DATA | _ERRORS | _SPEEDS_AND_ZONES | _FUNCTIONS | _INSTRUCTIONS | _TYPES

"""Installed routines that only an ABB controller has: instructions with their effect, functions with their type.

One table each. An instruction becomes a vendor statement with that effect; a function becomes a predefined routine
whose result a run has to be told. effect: none, message, time, unknown (see ir.Vendor). An instruction of the neutral
tables stands here too when some of its options have no neutral form.
"""

from __future__ import annotations

from .words import words

# Nothing that a run or a translation can show changes without them.
_NONE = words(
    """PathResol MotionSup SoftAct SoftDeact ActUnit DeactUnit TPShow PathRecStart PathRecStop SpyStart SpyStop
    ActEventBuffer DeactEventBuffer HollowWristReset ResetRetryCount ResetTorqueMargin SoftElbow Open Close
    MechUnitLoad PathAccLim WorldAccLim SkipWarn TuneServo TuneReset EOffsOff CorrClear ClearIOBuff
    ClearRawBytes TextTabInstall RMQEmptyQueue Save CloseDir CheckProgRef SyncMoveUndo UIShow"""
)
_MESSAGE = words(
    """ErrLog Write WriteAnyBin WriteBin WriteStrBin WriteRawBytes WriteCfgData Rewind RMQSendMessage SocketSend
    SocketSendTo ErrWrite TPWrite"""
)
_TIME = words("WaitLoad")
_UNKNOWN = words(
    """AliasIOReset CalibJ CalibL CamLoadImage CapC CapL CapAPTrSetup DispC DispL DitherAct DitherDeact EGMStreamStart
    EGMStreamStop FricIdEvaluate FricIdInit FricIdSetFricLevels GetJointData IOBusState IPathPos IndGunMove InitSuperv
    LoadId MToolRotCalib MToolTCPCalib MatrixSVD MatrixSolve MatrixSolveQR MotionProcessModeSet PaintC PaintL
    PathLengthReset PathLengthStart PathLengthStop ProcCall PrxActivAndStoreRecord PrxDbgStoreRecord PrxDeactRecord
    PrxResetPos PrxResetRecords PrxSetPosOffset PrxSetRecordSampleTime PrxSetSyncalarm PrxStartRecord PrxStopRecord
    PrxStoreRecord PrxUseFileRecord RemoveAllCyclicBool RemoveCyclicBool RemoveSuperv ResetAxisDistance
    ResetAxisMoveTime ResetPPMoved STCalib STClose STIndGun STIndGunReset STOpen STToolReset STTune STTuneReset
    SafetyControllerSyncRequest SaveCfgData SenDevice SetLeadThrough SetupCyclicBool SetupSuperv SiClose SiConnect
    SiGetCyclic SiSetCyclic TriggDataCopy TriggDataReset
    AccSet Add AliasIO ArcC ArcCEnd ArcCStart ArcL ArcLEnd ArcLStart ArcKill ArcRefresh BitClear BitSet
    CallByVar CamFlush CamGetParameter CamGetResult CamLoadJob CamReqImage CamSetExposure CamSetParameter
    CamSetProgramMode CamSetRunMode CamStartLoadJob CamWaitLoadJob CancelLoad CirPathMode ContactL
    CopyFile CopyRawBytes CorrCon CorrDiscon CorrWrite Decr DropSensor DropWObj EGMActJoint EGMActMove
    EGMActPose EGMGetId EGMMoveC EGMMoveL EGMReset EGMRunJoint EGMRunPose EGMSetupAI EGMSetupAO EGMSetupGI
    EGMSetupUC EGMStop EOffsOn EOffsSet EraseModule ErrRaise FCAct FCCalib FCDeact FCPress1LStart FCPressC
    FCPressEnd FCPressL FCRefStart FCRefStop GetDataVal GetSysData GetTrapData IError IOBusStart IODisable
    IOEnable IRMQMessage ISignalAI ISignalAO IVarValue Incr IndAMove IndCMove IndDMove IndRMove IndReset
    InvertDO Load MakeDir ManLoadIdProc MoveAbsJ MoveC MoveJ MoveL OpenDir PDispOn PackDNHeader
    PackRawBytes PathRecMoveBwd PathRecMoveFwd ProcerrRecovery PrxActivRecord PulseDO RMQFindSlot RMQGetMessage
    RMQGetMsgData RMQGetMsgHeader RMQReadWait RMQSendWait RaiseToUser ReadAnyBin ReadBlock ReadCfgData
    ReadErrData ReadRawBytes ReadVarArr RemoveDir RemoveFile RenameFile SCWrite SearchC SearchExtJ SearchL SetAO
    SetAllDataVal SetDO SetDataSearch SetDataVal SetGO SetSysData SingArea SocketAccept SocketBind SocketClose
    SocketConnect SocketCreate SocketListen SocketReceive SocketReceiveFrom SpeedLimAxis SpeedLimCheckPoint
    SpeedRefresh SpotJ SpotL SpotMJ SpotML StartLoad StartMove StepBwdPath StopMove StopMoveReset StorePath
    SupSyncSensorOff SupSyncSensorOn SyncMoveOff SyncMoveOn SyncMoveResume SyncMoveSuspend SyncToSensor
    SystemStopAction TPReadDnum TPReadFK TPReadNum TestSignDefine TestSignReset TriggC TriggCheckIO TriggEquip
    TriggIO TriggInt TriggJ TriggJIOs TriggL TriggLIOs TriggRampAO TriggSpeed TriggStopProc TryInt UIMsgBox
    UIMsgWrite UIMsgWriteAbort UnLoad UnpackRawBytes VelSet WZBoxDef WZCylDef WZDOSet WZDisable WZEnable WZFree
    WZHomeJointDef WZLimJointDef WZLimSup WZSphDef WaitAI WaitAO WaitDI WaitDO WaitGI WaitGO WaitSensor
    WaitSyncTask WaitTestAndSet WaitTime WaitUntil WaitWObj WarmStart WriteBlock WriteVar WriteVarArr"""
)

EFFECTS: dict[str, str] = {
    name.lower(): effect
    for effect, names in {"unknown": _UNKNOWN, "time": _TIME, "message": _MESSAGE, "none": _NONE}.items()
    for name in names
}

# Functions without a neutral built-in, by the type of their result.
# Some have a neutral built-in too, but an option of theirs has none.
_FUNCTIONS = {
    "bool": """GetNextSym BitCheck BitCheckDnum IndInpos IndSpeed IsCyclicBool IsFile IsMechUnitActive IsPers
        IsStopMoveAct IsStopStateEvent IsSyncMoveOn IsSysId IsVar PFRestart PathRecValidBwd PathRecValidFwd
        RobOS IsBrakeCheckActive IsLeadThrough ModExist NonMotionMode PPMovedInManMode STIsCalib STIsClosed STIsIndGun
        STIsOpen TaskInSync TaskIsActive TaskIsExecuting TasksInSync GetNextCyclicBool GetNextMechUnit
        StrDigCmp TaskRunMec TaskRunRob TestAndSet TextTabFreeToUse TriggDataValid UIClientExist
        ValidIO""",
    "num": """ClkRead Round Trunc EventType ExecHandler ExecLevel FSSize FileSize GetModalPayLoadMode GetTime
        IOUnitState MaxRobSpeed MotionPlannerNo OpMode ParIdPosValid ParIdRobValid ProgMemFree RawBytesLen
        ReadBin ReadMotor ReadNum RunMode SocketGetStatus SocketPeek TestSignRead TextTabGet UIListView
        UIMessageBox UINumEntry UINumTune BitLSh BitNeg CSpeedOverride CamNumberOfResults GetMotorTorque
        GetTaskNo StrFind ReadVar RemainingRetries PathLevel PathLengthGet FileTime ModTime CamGetExposure CamGetMode
        GetASIVersion GetAxisDistance GetAxisMoveTime GetMaxNumberOfCyclicBool GetNumberOfCyclicBool GetTorqueMargin
        MaxExtLinearSpeed MaxExtReorientSpeed MaxRobReorientSpeed PrxGetMaxRecordpos STCalcForce STCalcTorque
        GetTSPStatus EGMGetState""",
    "dnum": """BitLShDnum BitNegDnum BitRShDnum FSSizeDnum FileSizeDnum FileTimeDnum ModTimeDnum ReadDnum StrToDnum
        UIDnumEntry UIDnumTune""",
    "byte": "StrToByte",
    "string": """ArgName Type RobName GetSignalOrigin GetUASUserName SafetyControllerGetChecksum
        SafetyControllerGetSWVersion SafetyControllerGetUserChecksum
        ByteToStr CDate CTime NumToStr ValToStr CamGetLoadedJob CamGetName DecToHex EventName
        GetMecUnitName GetServiceInfo GetSysInfo GetTaskName HexToDec ReadDir ReadStr ReadStrBin RMQGetSlotName
        StrDigCalc StrFormat TextGet UIAlphaEntry""",
    "robtarget": "CRobT MirPos ORobT",
    "jointtarget": "CJointT CalcJointT",
    "pose": "DefAccFrame CalcRotAxFrameZ CalcRotAxisFrame",
    "pos": "CPos CorrRead",
}
FUNCTION_RESULTS: dict[str, str] = {name: result for result, names in _FUNCTIONS.items() for name in names.split()}
